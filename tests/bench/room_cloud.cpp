// SPDX-License-Identifier: BSD-3-Clause
#include "room_cloud.h"

#include <array>
#include <cmath>
#include <limits>

#include "libps/core/parallel.h"
#include "libps/geometry/lift.h"

namespace ps::bench {
namespace {

struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

const Box kRoom = {{-3, -1.5, -1}, {3, 1.5, 5}};
const std::array<Box, 3> kFurniture = {{{{-2, 0.3, 2.5}, {-0.8, 1.5, 3.5}},
                                        {{0.4, 0.8, 1.8}, {1.6, 1.5, 2.6}},
                                        {{1.9, -0.6, 3.6}, {2.8, 1.5, 4.6}}}};

/// Distance, in lengths of `ray`, to where the ray leaves (inside) or enters (outside) the box.
double hit_distance(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
                    bool inside) {
  const Eigen::Array3d a = (box.low - from).array() / ray.array();
  const Eigen::Array3d b = (box.high - from).array() / ray.array();
  const double enter = a.min(b).maxCoeff();
  const double leave = a.max(b).minCoeff();
  if (inside) return leave;
  return enter > 0 && enter < leave ? enter : std::numeric_limits<double>::infinity();
}

/// Coarse and fine waves, and tiles: neighbouring pixels differ, as in a photo.
cv::Vec3f texture(const Eigen::Vector3d& p) {
  const double wave =
      0.25 * std::sin(3 * p.x() + 2 * p.z()) + 0.15 * std::sin(41 * p.y() + 37 * p.x());
  const auto tile = [](double t) { return static_cast<int>(std::floor(4 * t)) & 1; };
  const double tiles = 0.2 * (tile(p.x() + 0.01) ^ tile(p.y() + 0.02) ^ tile(p.z() + 0.03));
  const double grain = 0.1 * std::sin(211 * p.x()) * std::sin(199 * p.y() + 223 * p.z());
  const double grey = 0.45 + wave + tiles + grain;
  const auto channel = [&](double tint) {
    return static_cast<float>(std::fmin(1, std::fmax(0, grey * tint)));
  };
  return {channel(1), channel(0.9 + 0.1 * std::sin(p.z())), channel(0.75)};
}

}  // namespace

View room_view(const Intrinsics& intrinsics, const Pose& world_from_cam) {
  View view;
  view.intrinsics = intrinsics;
  view.world_from_cam = world_from_cam;
  view.color = Image(intrinsics.height, intrinsics.width);
  view.depth = Depth(intrinsics.height, intrinsics.width);
  const Eigen::Vector3d from = world_from_cam.translation();
  parallel_for(intrinsics.height, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < intrinsics.width; ++x) {
      // The ray has length 1 along z, so that lengths of it are depths.
      const Eigen::Vector3d ray = world_from_cam.linear() * intrinsics.lift(x, y, 1);
      double depth = hit_distance(kRoom, from, ray, true);
      for (const Box& box : kFurniture)
        depth = std::fmin(depth, hit_distance(box, from, ray, false));
      view.depth(y, x) = static_cast<float>(depth);
      view.color(y, x) = texture(from + depth * ray);
    }
  });
  return view;
}

Intrinsics room_camera(int size) { return intrinsics_from_fov(size, size, 70); }

Pose room_target() {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.15, -0.1, -0.2);
  return pose;
}

Cloud room_cloud(std::size_t points) {
  const int size = static_cast<int>(std::lround(std::sqrt(static_cast<double>(points) / 2)));
  LiftOptions all;
  all.edge_footprints = 0;
  Pose second = Pose::Identity();
  second.linear() = Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitY()).toRotationMatrix();
  second.translation() = Eigen::Vector3d(0.4, 0.05, 0.1);
  Cloud cloud = lift(room_view(room_camera(size), Pose::Identity()), 0, Origin::observed, all);
  cloud += lift(room_view(room_camera(size), second), 1, Origin::observed, all);
  return cloud;
}

}  // namespace ps::bench
