// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: the inner loop of splatting, built for several vector widths.
#pragma once

#include <stdint.h>

namespace ps {
namespace splat_kernel {

constexpr int kTile = 16;  ///< side of a tile, pixels
constexpr int kTilePixels = kTile * kTile;

/// Where a tile keeps pixel (x, y). Four by four pixels are neighbours in memory, within them four
/// by two, within these two by two: a vector of 16, 8 or 4 floats is a compact block, as a splat
/// is.
constexpr int pixel_index(int x, int y) {
  return (y / 4 * (kTile / 4) + x / 4) * 16 + (y / 2 % 2) * 8 + (x / 2 % 2) * 4 + y % 2 * 2 + x % 2;
}

/// One point as it falls on the image plane.
struct TilePoint {
  float u, v, z;
  float r, g, b;
  float radius;  ///< pixels, within which it hits
  float inverse_r2;
};

/// What four by four pixels have gathered so far, in the order of pixel_index. A block's numbers
/// are together, so that no two of them fall on the same place of a 4 KiB page.
struct alignas(64) Gathered {
  float left[16];  ///< transmittance behind the hits so far
  float r[16];
  float g[16];
  float b[16];
  float z[16];      ///< sum of weight times depth
  float first[16];  ///< depth of the first hit; 0 = none
  int32_t count[16];
};

/// A tile starts as zeros, with `left` all 1 and `live` all ones.
struct Tile {
  Gathered blocks[kTilePixels / 16];
  uint64_t live;  ///< a bit for each vector of pixels: can it still change?
};

struct Params {
  float x0, y0;       ///< pixel of the tile's corner
  float enough;       ///< a pixel is done when `left` is below this
  int32_t most_hits;  ///< ... or when it has this many
  float deepest;      ///< no hit is so many times as deep as the first
};

/// Blends points, nearest first, over a tile. Returns whether a pixel is left that can change.
/// Every width does the same operations in the same order for each pixel: same bytes.
using Blend = bool (*)(Tile* tile, const TilePoint* points, int count, const Params& params);

bool blend_baseline(Tile*, const TilePoint*, int, const Params&);
bool blend_avx2(Tile*, const TilePoint*, int, const Params&);
bool blend_avx512(Tile*, const TilePoint*, int, const Params&);

}  // namespace splat_kernel
}  // namespace ps
