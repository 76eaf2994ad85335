// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: which points fall on which tile of the image.
#pragma once

#include <cstdint>
#include <vector>

#include "libps/geometry/splat.h"

namespace ps {

/// Points on the image plane, as arrays; a point that is not drawn has z = 0.
struct PlaneArrays {
  std::vector<float> u, v, z;
  std::vector<float> radius;  ///< pixels; empty = all have that of the options
};

/// @brief Projects points into a camera, in single precision; points at or before options.near, and
/// points that are not finite, get z = 0. Radii are filled in if options.finest asks for them.
PlaneArrays project_points(const PointsView& points, const Intrinsics& intrinsics,
                           const Pose& world_from_cam, const SplatOptions& options);

/// @brief For each tile of the image, the points that may hit it, in no order.
/// An entry is (depth's bits << 32) | index, so that sorting entries sorts by (depth, index).
struct TileBins {
  int columns = 0;
  int rows = 0;
  std::vector<std::size_t> start;  ///< first entry of each tile, and the end of the last
  std::vector<std::uint64_t> entries;
};

/// @param radius  of all points, unless they have their own
TileBins bin_points(const PlaneArrays& points, cv::Size size, float radius);

/// @brief Hands out one tile's entries nearest first without sorting what is never reached: entries
/// are spread over buckets of depth once, and each bucket is sorted when it is asked for.
class FrontToBack {
 public:
  /// @return entries in order, a part at a time; empty at the end
  struct Part {
    const std::uint64_t* begin;
    const std::uint64_t* end;
  };

  void start(std::uint64_t* begin, std::uint64_t* end);
  Part next();

 private:
  void spread(const std::uint64_t* begin, const std::uint64_t* end);

  std::vector<std::uint64_t> scratch_;
  std::vector<std::uint32_t> bucket_end_;
  std::uint64_t* data_ = nullptr;
  std::size_t bucket_ = 0;
  std::size_t given_ = 0;
};

}  // namespace ps
