// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/lift.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr std::size_t kRowsAtATime = 16;
/// In units of noise_of(): three sigma of normal noise. Two such jumps in a row are rare.
constexpr float kNoisyJump = 3.6f;
constexpr double kLongestLens = 2;  ///< short sides of the image; 48 mm on 36 mm x 24 mm

/// Positive and finite; written without branches, for whole rows at once.
bool known(float depth) {
  return static_cast<int>(depth > 0) & static_cast<int>(depth <= std::numeric_limits<float>::max());
}

/// Copies a row of depths, unknown ones as 0, and marks those in range.
void clean_row(const float* __restrict depth, int width, float least, float most,
               float* __restrict clean, std::uint8_t* __restrict keep) {
  for (int x = 0; x < width; ++x) {
    const float d = known(depth[x]) ? depth[x] : 0;
    clean[x] = d;
    keep[x] = static_cast<std::uint8_t>(static_cast<int>(d > 0) & static_cast<int>(d >= least) &
                                        static_cast<int>(d <= most));
  }
}

/// Clears the pixels of a row that hang between a surface in front and one behind, with the
/// neighbours at (x - dx) in the row `before` and (x + dx) in the row `after`. Unknown depths are
/// 0.
void clear_flying(const float* __restrict row, const float* __restrict before,
                  const float* __restrict after, int dx, int width, float jump_per_metre,
                  std::uint8_t* __restrict keep) {
  for (int x = std::abs(dx); x < width - std::abs(dx); ++x) {
    const float d = row[x], a = before[x - dx], b = after[x + dx], jump = jump_per_metre * d;
    const float low = std::min(a, b), high = std::max(a, b);
    keep[x] &=
        static_cast<std::uint8_t>(static_cast<int>(d - low <= jump) |
                                  static_cast<int>(high - d <= jump) | static_cast<int>(low <= 0));
  }
}

/// The middle difference of a pixel's depth from its neighbours' mean, along rows, as a share of
/// it: of a smooth image next to none, else the noise. Some pixels speak for all.
float noise_of(const Depth& clean) {
  constexpr int kStep = 3;
  std::vector<float> differences;
  for (int y = 0; y < clean.rows; y += kStep) {
    const float* row = clean[y];
    for (int x = 1; x + 1 < clean.cols; x += kStep) {
      if (!(row[x - 1] > 0 && row[x] > 0 && row[x + 1] > 0)) continue;
      differences.push_back(std::fabs(row[x] - .5f * (row[x - 1] + row[x + 1])) / row[x]);
    }
  }
  if (differences.empty()) return 0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle;
}

/// The least step of depth, as a share of it, that sets flying pixels apart.
float jump_per_metre(const Depth& clean, const Intrinsics& k, const LiftOptions& options) {
  double footprint = k.footprint_per_metre();
  if (options.estimated) {
    footprint = std::max(footprint, 1 / (kLongestLens * std::min(k.width, k.height)));
  }
  return std::max(static_cast<float>(options.edge_footprints * footprint),
                  kNoisyJump * noise_of(clean));
}

Point make_point(const Eigen::Vector3d& position, const cv::Vec3f& rgb, double footprint,
                 std::uint16_t view_number, Origin origin) {
  Point p;
  p.getVector3fMap() = position.cast<float>();
  p.r = to_byte(rgb[0]);
  p.g = to_byte(rgb[1]);
  p.b = to_byte(rgb[2]);
  p.footprint = static_cast<float>(footprint);
  p.view = view_number;
  p.origin = static_cast<std::uint8_t>(origin);
  return p;
}

}  // namespace

Mask liftable(const Depth& depth, const Intrinsics& intrinsics, const LiftOptions& options) {
  Mask result(depth.size());
  Depth clean(depth.size());  // unknown depths are 0, so that they are no surface in front
  const auto least = static_cast<float>(options.min_depth);
  const auto most = static_cast<float>(options.max_depth);
  parallel_chunks(depth.rows, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      clean_row(depth[y], depth.cols, least, most, clean[y], result[y]);
    }
  });
  if (options.edge_footprints <= 0) return result;
  const float jump = jump_per_metre(clean, intrinsics, options);
  parallel_chunks(depth.rows, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const auto clear = [&](int dy, int dx) {
        if (y < dy || y + dy >= depth.rows) return;
        clear_flying(clean[y], clean[y - dy], clean[y + dy], dx, depth.cols, jump, result[y]);
      };
      clear(0, 1);
      clear(1, 0);
      clear(1, 1);
      clear(1, -1);
    }
  });
  return result;
}

Cloud lift(const View& view, const Mask& pixels, std::uint16_t view_number, Origin origin) {
  check(view.intrinsics, "lift");
  checked_pose(view.world_from_cam.matrix(), "lift");
  const cv::Size size(view.intrinsics.width, view.intrinsics.height);
  if (view.depth.size() != size || view.color.size() != size || pixels.size() != size) {
    throw Error("lift", "photo, depth, mask and intrinsics differ in size", "one size");
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
