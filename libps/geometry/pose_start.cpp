// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "libps/geometry/pose_fit.h"

// OpenCV's RANSAC draws from generators of its own that start anew with each call: the same
// sightings give the same pose.
namespace ps {
namespace {

constexpr double kConfidence = 0.9999;
constexpr int kDraws = 5000;  ///< for a share of 0.2 of true matches, by four

Pose pose_of(const cv::Matx33d& rotation, const cv::Vec3d& translation) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose(i, j) = rotation(i, j);
    pose(i, 3) = translation[i];
  }
  return pose;
}

/// The baseline's length that makes the median depth right: a point z x + ... in the direction y
/// of the second camera has z R x + length t parallel to y.
double baseline_length(const std::vector<Sighting>& sightings,
                       const std::vector<cv::Point2d>& second, const Pose& unit,
                       const cv::Mat1b& inlier) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!inlier(static_cast<int>(i)) || !sightings[i].depth_known) continue;
    const Eigen::Vector3d y(second[i].x, second[i].y, 1);
    const Eigen::Vector3d moves = y.cross(unit.translation());
    const Eigen::Vector3d stays = y.cross(unit.linear() * sightings[i].point_in_first);
    lengths.push_back(-moves.dot(stays) / moves.squaredNorm());
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace

bool start_from_points(const std::vector<Sighting>& sightings, const Intrinsics& k,
                       double tolerance, Pose* second_from_first) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const Sighting& s : sightings) {
    if (!s.depth_known) continue;
    points.emplace_back(s.point_in_first.x(), s.point_in_first.y(), s.point_in_first.z());
    pixels.emplace_back(s.pixel_in_second.x(), s.pixel_in_second.y());
  }
  const cv::Matx33d lens(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
  cv::Vec3d turn, shift;
  if (points.size() < 5 || !cv::solvePnPRansac(points, pixels, lens, cv::noArray(), turn, shift,
                                               false, kDraws, static_cast<float>(tolerance),
                                               kConfidence, cv::noArray(), cv::SOLVEPNP_AP3P)) {
    return false;
  }
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  *second_from_first = pose_of(rotation, shift);
  return second_from_first->matrix().allFinite();
}

bool start_from_directions(const std::vector<Sighting>& sightings, const Intrinsics& k,
                           double tolerance, Pose* second_from_first) {
  std::vector<cv::Point2d> first, second;
  for (const Sighting& s : sightings) {
    const Eigen::Vector3d x = s.point_in_first / s.point_in_first.z();
    const Eigen::Vector3d y = k.lift(s.pixel_in_second.x(), s.pixel_in_second.y(), 1);
    first.emplace_back(x.x(), x.y());
    second.emplace_back(y.x(), y.y());
  }
  if (first.size() < 6) return false;
  cv::Mat1b inlier;
  const cv::Mat essential =
      cv::findEssentialMat(first, second, cv::Mat::eye(3, 3, CV_64F), cv::RANSAC, kConfidence,
                           tolerance / std::sqrt(k.fx * k.fy), inlier);
  if (essential.rows != 3 || essential.cols != 3) return false;
  cv::Matx33d rotation;
  cv::Vec3d direction;
  cv::recoverPose(essential, first, second, cv::Mat::eye(3, 3, CV_64F), rotation, direction,
                  inlier);
  Pose pose = pose_of(rotation, direction);
  pose.translation() *= baseline_length(sightings, second, pose, inlier);
  *second_from_first = pose;
  return pose.matrix().allFinite();
}

}  // namespace ps
