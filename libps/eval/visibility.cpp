// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/pairs.h"

namespace ps {
namespace {

constexpr char kWhere[] = "true_visibility";
constexpr double kRelative = 0.01;  ///< three times what the depth of a good sensor is off
/// Neighbours whose depths differ by more footprints than these are of two surfaces, as lifting
/// takes it.
constexpr double kEdgeFootprints = 8;

bool known(float depth) { return std::isfinite(depth) && depth > 0; }

void check_depth(const View& view) {
  check(view.intrinsics, kWhere);
  checked_pose(view.world_from_cam.matrix(), kWhere);
  const cv::Size size(view.intrinsics.width, view.intrinsics.height);
  if (view.depth.size() == size) return;
  throw Error(kWhere,
              "a depth has " + std::to_string(view.depth.cols) + "x" +
                  std::to_string(view.depth.rows) + " pixels",
              std::to_string(size.width) + "x" + std::to_string(size.height) + ", as its lens");
}

enum class Sight { seen, hidden, unknown };

/// @param z  of a surface in the source's camera, which it projects to (u, v)
Sight sight_of(const View& source, double u, double v, double z) {
  double depths[4];
  int count = 0;
  const int x0 = static_cast<int>(std::floor(u)), y0 = static_cast<int>(std::floor(v));
  for (int y = std::max(y0, 0); y <= std::min(y0 + 1, source.depth.rows - 1); ++y) {
    for (int x = std::max(x0, 0); x <= std::min(x0 + 1, source.depth.cols - 1); ++x) {
      if (known(source.depth(y, x))) depths[count++] = source.depth(y, x);
    }
  }
  if (count == 0) return Sight::unknown;
  const auto [low, high] = std::minmax_element(depths, depths + count);
  const double tolerance = (kRelative + source.intrinsics.footprint_per_metre()) * z;
  const auto between = [&](double a, double b) { return z >= a - tolerance && z <= b + tolerance; };
  const bool one_surface =
      *high - *low <= kEdgeFootprints * source.intrinsics.footprint_per_metre() * *low;
  const bool seen =
      one_surface ? between(*low, *high)
                  : std::any_of(depths, depths + count, [&](double d) { return between(d, d); });
  if (seen) return Sight::seen;
  return *low < z ? Sight::hidden : Sight::unknown;
}

Visibility looked_up(const View& source, const View& target) {
  const Pose source_from_target = source.world_from_cam.inverse() * target.world_from_cam;
  const Intrinsics& k = source.intrinsics;
  Visibility result = {Mask::zeros(target.depth.size()), Mask::zeros(target.depth.size())};
  parallel_for(static_cast<std::size_t>(target.depth.rows), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < target.depth.cols; ++x) {
      if (!known(target.depth(y, x))) continue;
      const Eigen::Vector3d point =
          source_from_target * target.intrinsics.lift(x, y, target.depth(y, x));
      const Eigen::Vector2d at = k.project(point);
      const bool inside = point.z() > 0 && at.x() >= -0.5 && at.y() >= -0.5 &&
                          at.x() <= k.width - 0.5 && at.y() <= k.height - 0.5;
      const Sight sight = inside ? sight_of(source, at.x(), at.y(), point.z()) : Sight::hidden;
      result.visible(y, x) = sight == Sight::seen;
      result.invisible(y, x) = sight == Sight::hidden;
    }
  });
  return result;
}

}  // namespace

Visibility true_visibility(const View& source, const View& target) {
  check_depth(source);
  check_depth(target);
  return looked_up(source, target);
}

}  // namespace ps
