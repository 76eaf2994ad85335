// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "libps/scene/stress_world.h"

namespace ps::stress {
namespace {

constexpr double kFlat = .03;  ///< metres from a plane that are on it

Eigen::Vector3d point_at(const View& view, int x, int y) {
  return view.world_from_cam * view.intrinsics.lift(x, y, view.depth(y, x));
}

Eigen::AlignedBox3d box_of(const std::vector<View>& frames) {
  Eigen::AlignedBox3d box;
  for (const View& view : frames) {
    for (int y = 0; y < view.depth.rows; ++y) {
      for (int x = 0; x < view.depth.cols; ++x) {
        if (view.depth(y, x) > 0) box.extend(point_at(view, x, y));
      }
    }
  }
  return box;
}

/// Metres from a place in the box to its walls.
double way_out(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from,
               const Eigen::Vector3d& direction) {
  double way = 1e3;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) < 1e-9) continue;
    const double wall = direction[k] > 0 ? box.max()[k] : box.min()[k];
    way = std::min(way, std::max(0.0, (wall - from[k]) / direction[k]));
  }
  return way;
}

}  // namespace

std::vector<View> with_mirror(const std::vector<View>& frames, double radius) {
  const View& first = frames.front();
  const int x0 = first.depth.cols / 2, y0 = first.depth.rows / 2;
  const Eigen::Vector3d middle = point_at(first, x0, y0);
  const Eigen::Vector3d normal = (point_at(first, x0 + 1, y0) - middle)
                                     .cross(point_at(first, x0, y0 + 1) - middle)
                                     .normalized();
  const Eigen::AlignedBox3d box = box_of(frames);
  std::vector<View> result = frames;
  for (View& view : result) {
    view.depth = view.depth.clone();
    const Eigen::Vector3d eye = view.world_from_cam.translation();
    for (int y = 0; y < view.depth.rows; ++y) {
      for (int x = 0; x < view.depth.cols; ++x) {
        const Eigen::Vector3d p = point_at(view, x, y), away = p - middle;
        const bool glass =
            view.depth(y, x) > 0 && away.norm() < radius && std::abs(away.dot(normal)) < kFlat;
        if (!glass) continue;
        const Eigen::Vector3d ray = (p - eye).normalized();
        const Eigen::Vector3d back = ray - 2 * ray.dot(normal) * normal;
        const double way = (p - eye).norm();
        view.depth(y, x) *= static_cast<float>((way + way_out(box, p, back)) / way);
      }
    }
  }
  return result;
}

}  // namespace ps::stress
