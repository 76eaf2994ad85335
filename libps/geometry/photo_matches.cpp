// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/photo_matches.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace ps {
namespace {

constexpr int kLongSide = 1600;  ///< finer pictures say little more, and take long
constexpr int kShortSide = 16;   ///< SIFT's coarsest octave needs some pixels
constexpr int kMostFeatures = 4000;
constexpr int kLayers = 3;          ///< of an octave: OpenCV's
constexpr double kContrast = 0.01;  ///< a quarter of OpenCV's: plain walls have little
constexpr double kEdge = 20;        ///< twice OpenCV's: rooms are full of edges
constexpr float kRatio = 0.8f;      ///< Lowe's
/// OpenCV's SIFT doubles the picture about pixels' corners, and gives places as if about centres.
constexpr double kSiftShift = 0.25;

struct Features {
  std::vector<Eigen::Vector2d> places;  ///< pixels of the photo
  cv::Mat descriptors;
};

cv::Mat1b gray_of(const Image& photo) {
  cv::Mat1f gray;
  cv::cvtColor(photo, gray, cv::COLOR_RGB2GRAY);
  cv::patchNaNs(gray, 0);
  const double shrink = pixels_per_feature_pixel(photo.size());
  if (shrink > 1) cv::resize(gray, gray, {}, 1 / shrink, 1 / shrink, cv::INTER_AREA);
  cv::Mat1b bytes;
  gray.convertTo(bytes, CV_8U, 255);
  return bytes;
}

/// RootSIFT (Arandjelovic and Zisserman, CVPR 2012): distances are Hellinger's, in which a few
/// great entries count for less.
void take_roots(cv::Mat descriptor) {
  const double sum = cv::norm(descriptor, cv::NORM_L1);
  if (sum > 0) cv::sqrt(descriptor / sum, descriptor);
}

Features features_of(const Image& photo) {
  Features features;
  if (photo.empty()) return features;
  const cv::Mat1b gray = gray_of(photo);
  if (std::min(gray.cols, gray.rows) < kShortSide) return features;
  std::vector<cv::KeyPoint> keypoints;
  cv::SIFT::create(kMostFeatures, kLayers, kContrast, kEdge)
      ->detectAndCompute(gray, cv::noArray(), keypoints, features.descriptors);
  for (int i = 0; i < features.descriptors.rows; ++i) take_roots(features.descriptors.row(i));
  const double sx = static_cast<double>(photo.cols) / gray.cols;
  const double sy = static_cast<double>(photo.rows) / gray.rows;
  for (const cv::KeyPoint& k : keypoints) {
    features.places.emplace_back((k.pt.x - kSiftShift + 0.5) * sx - 0.5,
                                 (k.pt.y - kSiftShift + 0.5) * sy - 0.5);
  }
  return features;
}

/// @return for each of `a`, the nearest of `b`, or -1 where another is nearly as near
std::vector<int> nearest(const cv::Mat& a, const cv::Mat& b) {
  std::vector<std::vector<cv::DMatch>> found;
  cv::BFMatcher(cv::NORM_L2).knnMatch(a, b, found, 2);
  std::vector<int> result;
  for (const auto& two : found) {
    const bool clear = two.size() == 2 && two[0].distance < kRatio * two[1].distance;
    result.push_back(clear ? two[0].trainIdx : -1);
  }
  return result;
}

}  // namespace

double pixels_per_feature_pixel(cv::Size photo) {
  return std::max(1.0, static_cast<double>(std::max(photo.width, photo.height)) / kLongSide);
}

std::vector<PixelMatch> match_photos(const Image& first, const Image& second) {
  const Features a = features_of(first), b = features_of(second);
  std::vector<PixelMatch> matches;
  if (a.places.size() < 2 || b.places.size() < 2) return matches;
  const std::vector<int> b_of_a = nearest(a.descriptors, b.descriptors);
  const std::vector<int> a_of_b = nearest(b.descriptors, a.descriptors);
  for (std::size_t i = 0; i < b_of_a.size(); ++i) {
    if (b_of_a[i] < 0 || a_of_b[b_of_a[i]] != static_cast<int>(i)) continue;
    const PixelMatch match{a.places[i], b.places[b_of_a[i]]};
    // Features of one place and several directions follow each other.
    const bool again = !matches.empty() && matches.back().first == match.first &&
                       matches.back().second == match.second;
    if (!again) matches.push_back(match);
  }
  return matches;
}

}  // namespace ps
