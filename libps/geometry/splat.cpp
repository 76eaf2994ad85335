// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/splat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/geometry/splat_bins.h"
#include "libps/geometry/splat_kernel.h"

namespace ps {
namespace {

using splat_kernel::kTile;
using splat_kernel::Tile;
using splat_kernel::TilePoint;

constexpr int kLargest = 16384;  ///< pixels on a side
constexpr int kBatch = 32;
/// Of splats that hide what is behind them: by their faint rim they would hide pixels' own points.
constexpr float kReach = 0.9f;
/// What is behind a transmittance this small changes an 8-bit colour by less than half a step.
constexpr float kEnough = 1.0f / 512;

splat_kernel::Blend pick_blend() {
#ifdef PS_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    return splat_kernel::blend_avx512;
  }
  if (__builtin_cpu_supports("avx2")) return splat_kernel::blend_avx2;
#endif
  return splat_kernel::blend_baseline;
}

void check(const SplatOptions& o, cv::Size size) {
  if (size.width <= 0 || size.height <= 0 || size.width > kLargest || size.height > kLargest) {
    throw Error("splat size", std::to_string(size.width) + "x" + std::to_string(size.height),
                "1x1 to 16384x16384");
  }
  if (!(o.radius > 0 && o.radius <= 64)) {
    throw Error("splat radius", std::to_string(o.radius), "more than 0 and at most 64 pixels");
  }
  if (!(o.finest >= 0)) throw Error("finest splat", std::to_string(o.finest), "0 pixels or more");
  if (!(o.thickness >= 0)) {
    throw Error("splat thickness", std::to_string(o.thickness), "0 or more");
  }
  if (!(o.near >= 0)) throw Error("splat near", std::to_string(o.near), "at least 0");
  if (o.points_per_pixel < 1) {
    throw Error("points per pixel", std::to_string(o.points_per_pixel), "at least 1");
  }
  if (o.dilation < 1 || o.dilation % 2 == 0) {
    throw Error("mask dilation", std::to_string(o.dilation), "an odd number of pixels");
  }
}

/// Draws one tile after another; each has its own part of the images, so tiles need no locks.
class Painter {
 public:
  Painter(const PlaneArrays& points, cv::Size size, const SplatOptions& options)
      : points_(points), options_(options), bins_(bin_points(points, size, options.radius)) {
    result_.color.create(size);
    result_.first_depth.create(size);
    result_.expected_depth.create(size);
    result_.hit.create(size);
    if (options.count_hits) {
      result_.count.create(size);
      result_.nearest.create(size);
      result_.nearest.setTo(cv::Scalar::all(-1));
    }
  }

  /// @param color_of  (index) -> cv::Vec3f
  template <typename ColorOf>
  Splat paint(const ColorOf& color_of) {
    const std::size_t tiles = bins_.start.size() - 1;
    parallel_for(tiles, [&](std::size_t i) { paint_tile(static_cast<int>(i), color_of); });
    cv::dilate(result_.hit == 0, result_.missing,
               cv::Mat1b(options_.dilation, options_.dilation, 1));
    result_.missing &= 1;
    return std::move(result_);
  }

 private:
  template <typename ColorOf>
  void paint_tile(int index, const ColorOf& color_of) {
    thread_local FrontToBack entries;
    Tile tile = {};
    for (auto& block : tile.blocks) std::fill(std::begin(block.left), std::end(block.left), 1.0f);
    tile.live = ~std::uint64_t{0};
    const int x0 = index % bins_.columns * kTile, y0 = index / bins_.columns * kTile;
    const splat_kernel::Params params = {static_cast<float>(x0), static_cast<float>(y0),
                                         options_.count_hits ? 0 : kEnough,
                                         options_.points_per_pixel, 1 + options_.thickness};
    entries.start(bins_.entries.data() + bins_.start[index],
                  bins_.entries.data() + bins_.start[index + 1]);
    std::array<TilePoint, kBatch> batch;
    bool live = true;
    for (auto part = entries.next(); live && part.begin != part.end; part = entries.next()) {
      for (const std::uint64_t* e = part.begin; live && e < part.end; e += kBatch) {
        const int count = static_cast<int>(std::min<std::ptrdiff_t>(kBatch, part.end - e));
        for (int i = 0; i < count; ++i) batch[i] = tile_point(e[i] & UINT32_MAX, color_of);
        if (options_.count_hits) list_nearest(e, batch.data(), count, x0, y0);
        live = blend_(&tile, batch.data(), count, params);
      }
    }
    store(tile, x0, y0);
  }

  template <typename ColorOf>
  TilePoint tile_point(std::size_t i, const ColorOf& color_of) const {
    const cv::Vec3f c = color_of(i);
    const float r = points_.radius.empty() ? options_.radius : points_.radius[i];
    return {points_.u[i], points_.v[i], points_.z[i], c[0], c[1], c[2], r * reach_, 1 / (r * r)};
  }

  void list_nearest(const std::uint64_t* entries, const TilePoint* points, int count, int x0,
                    int y0) {
    const int x1 = std::min(x0 + kTile, result_.color.cols);
    const int y1 = std::min(y0 + kTile, result_.color.rows);
    for (int i = 0; i < count; ++i) {
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
          const float dx = static_cast<float>(x) - points[i].u;
          const float dy = static_cast<float>(y) - points[i].v;
          if (!(dx * dx + dy * dy < points[i].radius * points[i].radius)) continue;
          cv::Vec4i& list = result_.nearest(y, x);
          int* end = list.val + std::min(4, options_.points_per_pixel);
          int* free = std::find(list.val, end, -1);
          if (free != end) *free = static_cast<int>(entries[i] & UINT32_MAX);
        }
      }
    }
  }

  void store(const Tile& tile, int x0, int y0) {
    const int width = std::min(kTile, result_.color.cols - x0);
    const int height = std::min(kTile, result_.color.rows - y0);
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const int index = splat_kernel::pixel_index(column, row), i = index % 16;
        const splat_kernel::Gathered& block = tile.blocks[index / 16];
        const float taken = 1 - block.left[i];
        const bool hit = block.count[i] > 0;
        cv::Vec3f color(block.r[i], block.g[i], block.b[i]);
        if (options_.renormalise && hit) {
          color *= taken > 0 ? 1 / taken : 0;
        } else {
          color += block.left[i] * options_.background;
        }
        const int x = x0 + column, y = y0 + row;
        result_.color(y, x) = color;
        result_.hit(y, x) = hit;
        result_.first_depth(y, x) = block.first[i];
        result_.expected_depth(y, x) = taken > 0 ? block.z[i] / taken : block.first[i];
        if (options_.count_hits) result_.count(y, x) = block.count[i];
      }
    }
  }

  const PlaneArrays& points_;
  const SplatOptions& options_;
  TileBins bins_;
  Splat result_;
  const splat_kernel::Blend blend_ = pick_blend();
  const float reach_ = std::isfinite(options_.thickness) ? kReach : 1;  ///< of a hit, in radii
};

}  // namespace

Splat splat(const PointsView& points, const Intrinsics& intrinsics, const Pose& world_from_cam,
            const SplatOptions& options) {
  const cv::Size size(intrinsics.width, intrinsics.height);
  check(options, size);
  check(intrinsics, "splat");
  checked_pose(world_from_cam.matrix(), "splat");
  const PlaneArrays plane = project_points(points, intrinsics, world_from_cam, options);
  return Painter(plane, size, options).paint([&](std::size_t i) {
    std::uint8_t bgr[3];
    std::memcpy(bgr, points.data + i * points.stride + points.rgb, sizeof bgr);
    return cv::Vec3f(bgr[2], bgr[1], bgr[0]) * (1.0f / 255);
  });
}

Splat splat_plane(const PlanePoints& points, cv::Size size, const SplatOptions& options) {
  check(options, size);
  const std::size_t count = points.u.size();
  if (points.v.size() != count || points.z.size() != count || points.color.size() != count) {
    throw Error("splat", "u, v, z and color differ in length", "one of each for each point");
  }
  PlaneArrays plane = {points.u, points.v, points.z, {}};
  for (std::size_t i = 0; i < count; ++i) {
    const bool drawn = plane.z[i] > options.near && std::isfinite(plane.z[i]) &&
                       std::isfinite(plane.u[i]) && std::isfinite(plane.v[i]);
    if (!drawn) plane.z[i] = 0;
  }
  return Painter(plane, size, options).paint([&](std::size_t i) { return points.color[i]; });
}

}  // namespace ps
