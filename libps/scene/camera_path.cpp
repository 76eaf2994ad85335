// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/camera_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libps/core/error.h"
#include "libps/geometry/point.h"

namespace ps {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Where the camera looks, radians: yaw to the right, pitch upwards.
struct Turn {
  double yaw = 0;
  double pitch = 0;
};

/// The extreme of a direction, as shares of the two ranges.
Turn extreme(const std::string& direction) {
  Turn turn;
  if (direction.find("left") != std::string::npos) turn.yaw = -1;
  if (direction.find("right") != std::string::npos) turn.yaw = 1;
  if (direction.find("up") != std::string::npos) turn.pitch = 1;
  if (direction.find("down") != std::string::npos) turn.pitch = -1;
  if (turn.yaw != 0 && turn.pitch != 0) return {turn.yaw / 2, turn.pitch / 2};
  return turn;
}

/// @param t  from 0 at the start of the path to 1 at its end
/// @return shares of the two ranges
Turn turn_at(const std::string& name, double t) {
  const double phase = 2 * kPi * t;
  if (name == "circle") return {-std::sin(phase), (std::cos(phase) - 1) / 2};
  if (name == "sway") return {-std::sin(phase), 0};
  const Turn end = extreme(name);
  return {t * end.yaw, t * end.pitch};
}

/// How far a closed path is at a frame, from 0 to 1: in even steps to a quarter of it, on to three
/// quarters and back, so that its two sides are among the frames, however few.
double closed_share(int frame, int frames) {
  const int last = frames - 1;
  const int left = std::max(1, static_cast<int>(std::lround(last / 4.0)));
  const int right = std::max(left + 1, last - left);
  if (frame <= left) return 0.25 * frame / left;
  if (frame <= right) return 0.25 + 0.5 * (frame - left) / (right - left);
  return 0.75 + 0.25 * (frame - right) / (last - right);
}

/// Camera y points down, so Ry(+) turns right and Rx(+) looks up.
Pose turned(const Pose& start, const Turn& turn, const PathOptions& options) {
  const Eigen::Matrix3d rotation =
      (Eigen::AngleAxisd(turn.yaw * options.range_horizontal, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(turn.pitch * options.range_vertical, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const Eigen::Vector3d pivot_in_cam(0, 0, options.orbit_radius);
  Pose start_from_cam = Pose::Identity();
  start_from_cam.linear() = rotation;
  start_from_cam.translation() = pivot_in_cam - rotation * pivot_in_cam;
  return start * start_from_cam;
}

void check_options(const std::string& name, const PathOptions& options) {
  const std::vector<std::string>& names = path_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    std::string choices;
    for (const std::string& choice : names) choices += (choices.empty() ? "" : ", ") + choice;
    throw Error("camera path", "there is none named '" + name + "'", "one of " + choices);
  }
  const auto sound = [](double range) { return range >= 0 && range <= kPi; };
  if (options.frames < 1) {
    throw Error("camera path", std::to_string(options.frames) + " frames", "at least 1");
  }
  if (!sound(options.range_horizontal) || !sound(options.range_vertical)) {
    throw Error("camera path", "a range is out of bounds", "0 to pi radians");
  }
  if (!(options.orbit_radius >= 0) || !std::isfinite(options.orbit_radius)) {
    throw Error("camera path", "the orbit radius is negative or not finite", "0 metres or more");
  }
}

/// Camera axes in the world when `up` is up; of the two level axes the later one is looked along.
Eigen::Matrix3d level_camera(const std::string& up) {
  const bool minus = !up.empty() && up.front() == '-';
  const std::string axis = minus ? up.substr(1) : up;
  if (axis != "x" && axis != "y" && axis != "z") {
    throw Error("framing", "no axis is named '" + up + "'", "x, y, z, -x, -y or -z");
  }
  const int number = axis.front() - 'x';
  Eigen::Matrix3d world_from_cam;
  world_from_cam.col(1) = (minus ? 1 : -1) * Eigen::Vector3d::Unit(number);
  world_from_cam.col(0) = Eigen::Vector3d::Unit(number == 0 ? 1 : 0);
  world_from_cam.col(2) = world_from_cam.col(0).cross(world_from_cam.col(1));
  return world_from_cam;
}

/// The corners, in the camera's axes, of a box that leaves out half a percent on each side.
std::pair<Eigen::Vector3d, Eigen::Vector3d> box_without_outliers(
    const pcl::PointCloud<Point>& cloud, const Eigen::Matrix3d& world_from_cam) {
  constexpr std::size_t kSamples = 200000;
  constexpr double kOutliers = 0.005;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSamples);
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3f direction = world_from_cam.col(axis).cast<float>();
    std::vector<float> values;
    for (std::size_t i = 0; i < cloud.size(); i += step) {
      values.push_back(direction.dot(cloud[i].getVector3fMap()));
    }
    const auto rank = [&](double share) {
      const auto nth = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), nth, values.end());
      return static_cast<double>(*nth);
    };
    low[axis] = rank(kOutliers);
    high[axis] = rank(1 - kOutliers);
  }
  return {low, high};
}

}  // namespace

const std::vector<std::string>& direction_names() {
  static const std::vector<std::string> names = {"left",    "right",    "up",        "down",
                                                 "up-left", "up-right", "down-left", "down-right"};
  return names;
}

const std::vector<std::string>& path_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"circle", "sway"};
    all.insert(all.end(), direction_names().begin(), direction_names().end());
    return all;
  }();
  return names;
}

std::vector<Pose> camera_path(const std::string& name, const Pose& start,
                              const PathOptions& options) {
  check_options(name, options);
  const bool closed = name == "circle" || name == "sway";
  std::vector<Pose> poses = {start};
  for (int i = 1; i < options.frames; ++i) {
    const double even = static_cast<double>(i) / (options.frames - 1);
    const double t = closed ? closed_share(i, options.frames) : even;
    // Exactly the start, not sin(2 pi) from it.
    poses.push_back(closed && t == 1 ? start : turned(start, turn_at(name, t), options));
  }
  return poses;
}

Framing frame_cloud(const pcl::PointCloud<Point>& cloud, const Intrinsics& intrinsics,
                    const std::string& up) {
  check(intrinsics, "framing");
  if (cloud.empty()) throw Error("framing", "the cloud is empty", "at least one point");
  Framing framing;
  framing.world_from_cam.linear() = level_camera(up);
  const auto [low, high] = box_without_outliers(cloud, framing.world_from_cam.linear());
  const Eigen::Vector3d half = (high - low) / 2;
  const double fit_width = half.x() * 2 * intrinsics.fx / intrinsics.width;
  const double fit_height = half.y() * 2 * intrinsics.fy / intrinsics.height;
  framing.distance = std::max({fit_width, fit_height, 0.1}) * 1.05 + half.z();
  framing.world_from_cam.translation() =
      framing.world_from_cam.linear() *
      ((low + high) / 2 - Eigen::Vector3d(0, 0, framing.distance));
  return framing;
}

std::string up_axis(const std::vector<Pose>& world_from_cam) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const Pose& pose : world_from_cam) up -= pose.linear().col(1);
  if (world_from_cam.empty()) return "y";
  int axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  return (up[axis] < 0 ? "-" : "") + std::string(1, static_cast<char>('x' + axis));
}

Intrinsics with_size(const Intrinsics& intrinsics, int width, int height) {
  const double scale = static_cast<double>(width) / intrinsics.width;
  Intrinsics sized = intrinsics;
  sized.width = width;
  sized.height = height;
  sized.fx *= scale;
  sized.fy *= scale;
  sized.cx = (intrinsics.cx + 0.5) * scale - 0.5;
  // The height's middle stays the middle; pixel centres are at integers.
  sized.cy = (intrinsics.cy + 0.5 - intrinsics.height / 2.0) * scale + height / 2.0 - 0.5;
  return sized;
}

}  // namespace ps
