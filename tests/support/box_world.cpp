// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/box_world.h"

#include <array>
#include <cmath>
#include <limits>

namespace ps {
namespace {

using Eigen::Vector3d;

struct Box {
  Vector3d low, high;
};

const Box kRoom = {{-3, -1.5, -4}, {3, 1.5, 4}};
const std::array<Box, 3> kBoxes = {{{{-2.0, 0.3, 1.0}, {-0.8, 1.5, 2.2}},
                                    {{0.9, -0.4, 1.8}, {1.6, 1.5, 2.6}},
                                    {{-0.5, 0.9, 2.9}, {0.7, 1.5, 3.5}}}};

/// Distances at which a ray enters and leaves a box (Kay and Kajiya's slabs).
std::pair<double, double> slabs(const Box& box, const Vector3d& from, const Vector3d& along) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.low[axis] - from[axis]) / along[axis];
    const double b = (box.high[axis] - from[axis]) / along[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

cv::Vec3f color_at(const Vector3d& p) {
  const auto wave = [](double x) { return static_cast<float>(0.5 + 0.4 * std::sin(x)); };
  return {wave(2.1 * p.x() + 0.7 * p.y()), wave(1.7 * p.y() - 1.3 * p.z()),
          wave(1.9 * p.z() + 1.1 * p.x())};
}

}  // namespace

View box_world_view(const Intrinsics& k, const Pose& world_from_cam) {
  View view;
  view.intrinsics = k;
  view.world_from_cam = world_from_cam;
  view.color.create(k.height, k.width);
  view.depth.create(k.height, k.width);
  const Vector3d from = world_from_cam.translation();
  for (int y = 0; y < k.height; ++y) {
    for (int x = 0; x < k.width; ++x) {
      const Vector3d along = world_from_cam.linear() * k.lift(x, y, 1);
      double depth = slabs(kRoom, from, along).second;
      for (const Box& box : kBoxes) {
        const auto [enter, leave] = slabs(box, from, along);
        if (enter > 0 && enter < leave) depth = std::min(depth, enter);
      }
      view.depth(y, x) = static_cast<float>(depth);
      view.color(y, x) = color_at(from + depth * along);
    }
  }
  return view;
}

Pose pose_at(double x, double y, double z, double yaw, double pitch) {
  Pose pose = Pose::Identity();
  pose.translation() = Vector3d(x, y, z);
  pose.linear() =
      (Eigen::AngleAxisd(yaw, Vector3d::UnitY()) * Eigen::AngleAxisd(pitch, Vector3d::UnitX()))
          .toRotationMatrix();
  return pose;
}

std::vector<Pose> box_world_walk(int count) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const double t = 2 * M_PI * i / count;
    poses.push_back(pose_at(1.2 * std::sin(t), 0.2 * std::cos(2 * t), -2 + 0.8 * std::cos(t),
                            0.5 * std::sin(t + 1), 0.1 * std::sin(3 * t)));
  }
  return poses;
}

}  // namespace ps
