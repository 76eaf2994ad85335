// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: the inner loop of splatting, built for several vector widths.
#pragma once

#include <stdint.h>

namespace ps {
namespace splat_kernel {

constexpr int kTile = 16;  ///< side of a tile, pixels

/// One point as it falls on the image plane.
struct TilePoint {
  float u, v, z;
  float r, g, b;
};

/// What a tile has gathered so far, row-major. Starts as zeros, with `left` all 1.
struct alignas(64) Tile {
  float left[kTile * kTile];  ///< transmittance behind the hits so far
  float r[kTile * kTile];
  float g[kTile * kTile];
  float b[kTile * kTile];
  float z[kTile * kTile];      ///< sum of weight times depth
  float first[kTile * kTile];  ///< depth of the first hit; 0 = none
  int32_t count[kTile * kTile];
  uint8_t live[kTile * kTile];  ///< for each vector of pixels: can it still change?
};

struct Params {
  float x0, y0;       ///< pixel of the tile's corner
  float radius;       ///< pixels
  float enough;       ///< a pixel is done when `left` is below this
  int32_t most_hits;  ///< ... or when it has this many
};

/// Blends points, nearest first, over a tile. Returns whether a pixel is left that can change.
/// Every width does the same operations in the same order for each pixel: same bytes.
using Blend = bool (*)(Tile* tile, const TilePoint* points, int count, const Params& params);

bool blend_baseline(Tile*, const TilePoint*, int, const Params&);
bool blend_avx2(Tile*, const TilePoint*, int, const Params&);
bool blend_avx512(Tile*, const TilePoint*, int, const Params&);

}  // namespace splat_kernel
}  // namespace ps
