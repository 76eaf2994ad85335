// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/splat_bins.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/geometry/splat_kernel.h"

namespace ps {
namespace {

using splat_kernel::kTile;

constexpr std::size_t kChunk = 16384;
constexpr std::size_t kMostParts = 64;
constexpr std::size_t kBucket = 12;  ///< entries aimed at in a bucket of depth

std::uint32_t bits_of(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// The tiles a point may hit: columns [c0, c1], rows [r0, r1]; empty when c0 > c1.
struct TileRange {
  std::int16_t c0 = 0, c1 = -1, r0 = 0, r1 = -1;
};

class TileRanges {
 public:
  TileRanges(const PlaneArrays& points, cv::Size size, float radius)
      : points_(points), size_(size), radius_(radius) {}

  TileRange operator()(std::size_t i) const {
    const float u = points_.u[i], v = points_.v[i];
    if (points_.z[i] <= 0) return {};
    const float r = points_.radius.empty() ? radius_ : points_.radius[i];
    const float left = u - r, right = u + r, top = v - r, bottom = v + r;
    if (!(right >= 0 && bottom >= 0 && left <= size_.width - 1 && top <= size_.height - 1)) {
      return {};
    }
    return {tile(left, size_.width), tile(right, size_.width), tile(top, size_.height),
            tile(bottom, size_.height)};
  }

 private:
  static std::int16_t tile(float at, int size) {
    const auto pixel = static_cast<int>(std::min(std::max(at, 0.f), static_cast<float>(size - 1)));
    return static_cast<std::int16_t>(pixel / kTile);
  }

  const PlaneArrays& points_;
  cv::Size size_;
  float radius_;
};

/// @param focal  pixels
/// @param z      depth of the point, metres
/// @return its radius, pixels
float radius_of(const PointsView& points, std::size_t i, float focal, float z,
                const SplatOptions& options) {
  if (points.footprint == 0) return options.finest;
  float footprint;
  std::memcpy(&footprint, points.data + i * points.stride + points.footprint, sizeof footprint);
  const float wanted = focal * footprint / z;
  // Also what is no number is drawn as fine as may be.
  return wanted > options.finest ? std::min(wanted, options.radius) : options.finest;
}

}  // namespace

PlaneArrays project_points(const PointsView& points, const Intrinsics& k,
                           const Pose& world_from_cam, const SplatOptions& options) {
  const Eigen::Matrix<double, 3, 4> exact = world_from_cam.inverse().matrix().topRows<3>();
  float m[3][4];
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      m[row][column] = static_cast<float>(exact(row, column));
  }
  const auto fx = static_cast<float>(k.fx), fy = static_cast<float>(k.fy);
  const auto cx = static_cast<float>(k.cx), cy = static_cast<float>(k.cy);
  PlaneArrays plane;
  plane.u.resize(points.count);
  plane.v.resize(points.count);
  plane.z.resize(points.count);
  const bool own_radii = options.finest > 0 && options.finest < options.radius;
  if (own_radii) plane.radius.resize(points.count);
  const float focal = std::sqrt(fx * fy);
  parallel_chunks(points.count, kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float p[3];
      std::memcpy(p, points.data + i * points.stride, sizeof p);
      const float x = m[0][0] * p[0] + m[0][1] * p[1] + m[0][2] * p[2] + m[0][3];
      const float y = m[1][0] * p[0] + m[1][1] * p[1] + m[1][2] * p[2] + m[1][3];
      const float z = m[2][0] * p[0] + m[2][1] * p[1] + m[2][2] * p[2] + m[2][3];
      const float u = fx * x / z + cx, v = fy * y / z + cy;
      const bool drawn =
          z > options.near && std::isfinite(z) && std::isfinite(u) && std::isfinite(v);
      plane.u[i] = u;
      plane.v[i] = v;
      plane.z[i] = drawn ? z : 0;
      if (own_radii) plane.radius[i] = radius_of(points, i, focal, z, options);
    }
  });
  return plane;
}

TileBins bin_points(const PlaneArrays& points, cv::Size size, float radius) {
  const std::size_t count = points.u.size();
  if (count > UINT32_MAX) throw Error("splat", "more than 4294967295 points", "fewer");
  TileBins bins;
  bins.columns = (size.width + kTile - 1) / kTile;
  bins.rows = (size.height + kTile - 1) / kTile;
  const std::size_t tiles = static_cast<std::size_t>(bins.columns) * bins.rows;
  const TileRanges range_of(points, size, radius);

  // Few parts, so that counters stay small beside the points; tiles sort their entries themselves.
  const std::size_t parts =
      std::min<std::size_t>({4u * threads(), kMostParts, (count + kChunk - 1) / kChunk});
  const std::size_t part_size = parts ? (count + parts - 1) / parts : 1;
  std::vector<std::vector<std::size_t>> at(parts, std::vector<std::size_t>(tiles, 0));
  std::vector<TileRange> ranges(count);
  const auto for_each_tile = [&](const TileRange& range, const auto& visit) {
    for (int row = range.r0; row <= range.r1; ++row) {
      for (int column = range.c0; column <= range.c1; ++column) visit(row * bins.columns + column);
    }
  };
  parallel_chunks(count, part_size, [&](std::size_t begin, std::size_t end) {
    std::size_t* counts = at[begin / part_size].data();
    for (std::size_t i = begin; i < end; ++i) {
      ranges[i] = range_of(i);
      for_each_tile(ranges[i], [&](int tile) { ++counts[tile]; });
    }
  });
  bins.start.resize(tiles + 1);
  std::size_t total = 0;
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    bins.start[tile] = total;
    for (auto& part : at) total += std::exchange(part[tile], total);
  }
  bins.start[tiles] = total;
  bins.entries.resize(total);
  parallel_chunks(count, part_size, [&](std::size_t begin, std::size_t end) {
    std::size_t* next = at[begin / part_size].data();
    std::uint64_t* entries = bins.entries.data();
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t entry = static_cast<std::uint64_t>(bits_of(points.z[i])) << 32 | i;
      for_each_tile(ranges[i], [&](int tile) { entries[next[tile]++] = entry; });
    }
  });
  return bins;
}

void FrontToBack::start(std::uint64_t* begin, std::uint64_t* end) {
  const auto count = static_cast<std::size_t>(end - begin);
  bucket_ = 0;
  given_ = 0;
  if (count <= 4 * kBucket) {
    bucket_end_.assign(1, static_cast<std::uint32_t>(count));
    data_ = begin;
  } else {
    spread(begin, end);
    data_ = scratch_.data();
  }
}

void FrontToBack::spread(const std::uint64_t* begin, const std::uint64_t* end) {
  const auto count = static_cast<std::size_t>(end - begin);
  std::uint64_t low = begin[0] >> 32, high = low;
  for (const std::uint64_t* e = begin; e != end; ++e) {
    low = std::min(low, *e >> 32);
    high = std::max(high, *e >> 32);
  }
  // Depth's bits grow with depth, so equal steps of them are an ordering into buckets.
  const std::uint64_t buckets = std::min<std::uint64_t>(count / kBucket, 1u << 14);
  const double scale = static_cast<double>(buckets) / static_cast<double>(high - low + 1);
  const auto bucket_of = [&](std::uint64_t entry) {  // signed: one instruction each way
    const auto steps = static_cast<std::int64_t>((entry >> 32) - low);
    return static_cast<std::int64_t>(static_cast<double>(steps) * scale);
  };
  bucket_end_.assign(buckets + 1, 0);
  for (const std::uint64_t* e = begin; e != end; ++e) ++bucket_end_[bucket_of(*e) + 1];
  for (std::size_t b = 1; b <= buckets; ++b) bucket_end_[b] += bucket_end_[b - 1];
  if (scratch_.size() < count) scratch_.resize(count);
  for (const std::uint64_t* e = begin; e != end; ++e) scratch_[bucket_end_[bucket_of(*e)]++] = *e;
  bucket_end_.pop_back();  // each start has become its bucket's end
}

FrontToBack::Part FrontToBack::next() {
  while (bucket_ < bucket_end_.size() && bucket_end_[bucket_] == given_) ++bucket_;
  if (bucket_ == bucket_end_.size()) return {nullptr, nullptr};
  std::uint64_t* begin = data_ + given_;
  std::uint64_t* end = data_ + bucket_end_[bucket_];
  std::sort(begin, end);
  given_ = bucket_end_[bucket_++];
  return {begin, end};
}

}  // namespace ps
