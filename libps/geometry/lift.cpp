// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/lift.h"

#include <array>
#include <cmath>
#include <vector>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr std::size_t kRowsAtATime = 16;

bool known(float depth) { return depth > 0 && std::isfinite(depth); }

/// Is (x, y) between a surface in front and one behind, along any of four directions?
bool flying(const Depth& depth, int x, int y, float jump) {
  static constexpr std::array<std::array<int, 2>, 4> kDirections = {
      {{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  const float d = depth(y, x);
  for (const auto& [dx, dy] : kDirections) {
    const int x1 = x - dx, y1 = y - dy, x2 = x + dx, y2 = y + dy;
    if (x1 < 0 || x2 >= depth.cols || y1 < 0 || y2 < 0 || y1 >= depth.rows || y2 >= depth.rows) {
      continue;
    }
    const float a = depth(y1, x1), b = depth(y2, x2);
    if (!known(a) || !known(b)) continue;
    if ((d - a > jump && b - d > jump) || (d - b > jump && a - d > jump)) return true;
  }
  return false;
}

Point make_point(const Eigen::Vector3d& position, const cv::Vec3f& rgb, double footprint,
                 std::uint16_t view_number, Origin origin) {
  const auto byte = [](float c) {
    return static_cast<std::uint8_t>(std::lround(std::fmin(std::fmax(c, 0.f), 1.f) * 255));
  };
  Point p;
  p.getVector3fMap() = position.cast<float>();
  p.r = byte(rgb[0]);
  p.g = byte(rgb[1]);
  p.b = byte(rgb[2]);
  p.footprint = static_cast<float>(footprint);
  p.view = view_number;
  p.origin = static_cast<std::uint8_t>(origin);
  return p;
}

}  // namespace

Mask liftable(const Depth& depth, const Intrinsics& intrinsics, const LiftOptions& options) {
  Mask result(depth.size(), 0);
  const auto jump_per_metre =
      static_cast<float>(options.edge_footprints * intrinsics.footprint_per_metre());
  parallel_chunks(depth.rows, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < depth.cols; ++x) {
        const float d = depth(y, x);
        if (!known(d) || d < options.min_depth || d > options.max_depth) continue;
        result(y, x) = jump_per_metre <= 0 || !flying(depth, x, y, jump_per_metre * d);
      }
    }
  });
  return result;
}

Cloud lift(const View& view, const Mask& pixels, std::uint16_t view_number, Origin origin) {
  check(view.intrinsics, "lift");
  if (view.depth.size() != pixels.size() || view.color.size() != pixels.size()) {
    throw Error("lift", "photo, depth and mask differ in size", "one size");
  }
  const Intrinsics& k = view.intrinsics;
  std::vector<std::size_t> row_start(pixels.rows + 1, 0);
  for (int y = 0; y < pixels.rows; ++y) {
    row_start[y + 1] = row_start[y] + cv::countNonZero(pixels.row(y));
  }
  Cloud cloud;
  cloud.resize(row_start.back());
  parallel_chunks(pixels.rows, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    std::size_t at = row_start[begin];
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < pixels.cols; ++x) {
        if (!pixels(y, x)) continue;
        const float d = view.depth(y, x);
        cloud[at++] = make_point(view.world_from_cam * k.lift(x, y, d), view.color(y, x),
                                 d * k.footprint_per_metre(), view_number, origin);
      }
    }
  });
  return cloud;
}

Cloud lift(const View& view, std::uint16_t view_number, Origin origin, const LiftOptions& options) {
  return lift(view, liftable(view.depth, view.intrinsics, options), view_number, origin);
}

}  // namespace ps
