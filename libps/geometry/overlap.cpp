// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/overlap.h"

#include <algorithm>
#include <cmath>

#include "libps/geometry/lift.h"

namespace ps {
namespace {

/// Depths of neighbouring pixels that differ more are of two surfaces.
constexpr double kStep = 1.1;

}  // namespace

double surface_depth(const Depth& depth, const Mask& usable, double u, double v) {
  if (!(u >= -0.5 && v >= -0.5 && u <= depth.cols - 0.5 && v <= depth.rows - 0.5)) return 0;
  u = std::clamp(u, 0.0, depth.cols - 1.0);
  v = std::clamp(v, 0.0, depth.rows - 1.0);
  const int x = std::min(static_cast<int>(u), std::max(depth.cols - 2, 0));
  const int y = std::min(static_cast<int>(v), std::max(depth.rows - 2, 0));
  const double across[2] = {1 - (u - x), u - x}, down[2] = {1 - (v - y), v - y};
  double inverse = 0, least = HUGE_VAL, most = 0;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      if (across[i] * down[j] == 0) continue;
      if (!usable(y + j, x + i)) return 0;
      const double d = depth(y + j, x + i);
      inverse += across[i] * down[j] / d;
      least = std::min(least, d);
      most = std::max(most, d);
    }
  }
  return most > kStep * least ? 0 : 1 / inverse;
}

std::vector<DepthRatio> depth_ratios(const View& first, const View& second, std::size_t most) {
  const Mask from = liftable(first.depth, first.intrinsics);
  const Mask to = liftable(second.depth, second.intrinsics);
  const Pose second_from_first = second.world_from_cam.inverse() * first.world_from_cam;
  const double share =
      static_cast<double>(from.total()) / static_cast<double>(std::max<std::size_t>(most, 1));
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(share))));
  std::vector<DepthRatio> ratios;
  for (int y = step / 2; y < from.rows; y += step) {
    for (int x = step / 2; x < from.cols; x += step) {
      if (!from(y, x)) continue;
      const Eigen::Vector3d p = second_from_first * first.intrinsics.lift(x, y, first.depth(y, x));
      if (p.z() <= 0) continue;
      const Eigen::Vector2d at = second.intrinsics.project(p);
      const double d = surface_depth(second.depth, to, at.x(), at.y());
      if (d <= 0) continue;
      ratios.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()),
                        static_cast<float>(std::log(p.z() / d))});
    }
  }
  return ratios;
}

}  // namespace ps
