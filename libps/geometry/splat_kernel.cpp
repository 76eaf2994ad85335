// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set (PS_ISA). C headers only: nothing inline may be shared.
#include "libps/geometry/splat_kernel.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define PS_JOIN2(a, b) a##b
#define PS_JOIN(a, b) PS_JOIN2(a, b)

namespace ps {
namespace splat_kernel {
namespace {

#if defined(__AVX512F__)

constexpr int kBlockWidth = 4, kBlockHeight = 4;
typedef float Floats __attribute__((vector_size(64), may_alias));
typedef int32_t Ints __attribute__((vector_size(64), may_alias));
typedef __mmask16 Lanes;
inline Floats square_root(Floats x) { return (Floats)_mm512_sqrt_ps((__m512)x); }
inline Lanes less(Floats a, Floats b) {
  return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
}
inline Lanes less(Ints a, Ints b) { return _mm512_cmplt_epi32_mask((__m512i)a, (__m512i)b); }
inline Lanes is_zero(Ints a) { return _mm512_testn_epi32_mask((__m512i)a, (__m512i)a); }
inline Floats select(Lanes m, Floats a, Floats b) {
  return (Floats)_mm512_mask_blend_ps(m, (__m512)b, (__m512)a);
}
inline Ints increment(Ints a, Lanes m) {
  return (Ints)_mm512_mask_sub_epi32((__m512i)a, m, (__m512i)a, _mm512_set1_epi32(-1));
}
inline bool any(Lanes m) { return m != 0; }

#else

#if defined(__AVX2__)
constexpr int kBlockWidth = 4, kBlockHeight = 2;
#else
constexpr int kBlockWidth = 2, kBlockHeight = 2;
#endif
constexpr int kBytes = 4 * kBlockWidth * kBlockHeight;
typedef float Floats __attribute__((vector_size(kBytes), may_alias));
typedef int32_t Ints __attribute__((vector_size(kBytes), may_alias));
typedef Ints Lanes;
inline Lanes less(Floats a, Floats b) { return a < b; }
inline Lanes less(Ints a, Ints b) { return a < b; }
inline Lanes is_zero(Ints a) { return a == 0; }
inline Floats select(Lanes m, Floats a, Floats b) { return m ? a : b; }
inline Ints increment(Ints a, Lanes m) { return a - m; }
#if defined(__AVX2__)
inline Floats square_root(Floats x) { return (Floats)_mm256_sqrt_ps((__m256)x); }
inline bool any(Lanes m) { return _mm256_movemask_ps((__m256)m) != 0; }
#elif defined(__SSE2__)
inline Floats square_root(Floats x) { return (Floats)_mm_sqrt_ps((__m128)x); }
inline bool any(Lanes m) { return _mm_movemask_ps((__m128)m) != 0; }
#else
inline Floats square_root(Floats x) {
  for (int i = 0; i < 4; ++i) x[i] = __builtin_sqrtf(x[i]);
  return x;
}
inline bool any(Lanes m) { return (m[0] | m[1] | m[2] | m[3]) != 0; }
#endif

#endif

constexpr int kLanes = kBlockWidth * kBlockHeight;
constexpr int kColumns = kTile / kBlockWidth, kRows = kTile / kBlockHeight;

inline Floats& floats(float* p) { return *reinterpret_cast<Floats*>(p); }
inline Ints& ints(int32_t* p) { return *reinterpret_cast<Ints*>(p); }
inline Floats all(float x) { return Floats{} + x; }

/// First place in memory of a block. Blocks are counted row by row over the tile.
inline int block_start(int block) {
  return pixel_index(block % kColumns * kBlockWidth, block / kColumns * kBlockHeight);
}

inline int clamp_pixel(float x) {
  const float at_least = x > 0.0f ? x : 0.0f;  // written as the machine's max and min: no branch
  return static_cast<int>(at_least < kTile - 1.0f ? at_least : kTile - 1.0f);
}

/// A bit for each block that the square around a splat touches.
inline uint64_t touched(TilePoint p, Params params) {
  const float x = p.u - params.x0, y = p.v - params.y0, r = p.radius;
  const int c0 = clamp_pixel(x - r) / kBlockWidth, c1 = clamp_pixel(x + r) / kBlockWidth;
  const int r0 = clamp_pixel(y - r) / kBlockHeight, r1 = clamp_pixel(y + r) / kBlockHeight;
  const uint64_t columns = (2ull << c1) - (1ull << c0);
  uint64_t every_row = 0;
  for (int row = 0; row < kRows; ++row) every_row |= 1ull << (row * kColumns);
  const uint64_t rows_below =
      (r1 + 1) * kColumns == 64 ? ~0ull : (1ull << ((r1 + 1) * kColumns)) - 1;
  return columns * every_row & rows_below & ~((1ull << (r0 * kColumns)) - 1);
}

/// SPEC.md 4: alpha = 1 - sqrt(clamp(d^2 / r^2, 1e-3, 1)); a hit is strictly inside the radius.
inline void blend_block(Gathered* block, int at, TilePoint p, Floats d2, Params params) {
  Floats& left = floats(block->left + at);
  Ints& count = ints(block->count + at);
  const Lanes inside = less(d2, all(p.radius * p.radius));
  const Lanes of_surface =
      is_zero(count) | less(all(p.z), floats(block->first + at) * params.deepest);
  const Lanes hit = inside & of_surface & ~less(left, all(params.enough)) &
                    less(count, Ints{} + params.most_hits);
  // Wide blocks are mostly hit, and a branch that is hard to foretell costs more than the sums.
  if (kLanes < 16 && !any(hit)) return;
  const Floats share = d2 * p.inverse_r2;
  const Floats low = select(less(share, all(1e-3f)), all(1e-3f), share);
  const Floats alpha = 1.0f - square_root(select(less(all(1.0f), low), all(1.0f), low));
  const Floats weight = select(hit, alpha * left, Floats{});
  const Lanes first = hit & is_zero(count);
  floats(block->first + at) = select(first, all(p.z), floats(block->first + at));
  count = increment(count, hit);
  left -= weight;
  floats(block->r + at) += weight * p.r;
  floats(block->g + at) += weight * p.g;
  floats(block->b + at) += weight * p.b;
  floats(block->z + at) += weight * p.z;
}

/// Those of the live blocks in which a pixel can still change.
inline uint64_t still_live(Tile* tile, uint64_t live, const Params& params) {
  for (uint64_t blocks = live; blocks; blocks &= blocks - 1) {
    const int bit = __builtin_ctzll(blocks), start = block_start(bit), at = start % 16;
    Gathered* block = tile->blocks + start / 16;
    const Lanes can = ~less(floats(block->left + at), all(params.enough)) &
                      less(ints(block->count + at), Ints{} + params.most_hits);
    if (!any(can)) live &= ~(1ull << bit);
  }
  return live;
}

}  // namespace

bool PS_JOIN(blend_, PS_ISA)(Tile* tile, const TilePoint* points, int count, const Params& given) {
  const Params params = given;  // a copy that no store into the tile can change
  uint64_t live = tile->live;
  if (kColumns * kRows < 64) live &= (1ull << (kColumns * kRows % 64)) - 1;
  float block_x[kColumns * kRows], block_y[kColumns * kRows];
  for (int block = 0; block < kColumns * kRows; ++block) {
    block_x[block] = static_cast<float>(block % kColumns * kBlockWidth);
    block_y[block] = static_cast<float>(block / kColumns * kBlockHeight);
  }
  Floats lane_x, lane_y;
  for (int y = 0; y < kBlockHeight; ++y) {
    for (int x = 0; x < kBlockWidth; ++x) {
      lane_x[pixel_index(x, y)] = params.x0 + static_cast<float>(x);
      lane_y[pixel_index(x, y)] = params.y0 + static_cast<float>(y);
    }
  }
  for (int i = 0; i < count; ++i) {
    const TilePoint p = points[i];
    for (uint64_t blocks = live & touched(p, params); blocks; blocks &= blocks - 1) {
      const int block = __builtin_ctzll(blocks);
      const Floats dx = lane_x + block_x[block] - p.u;
      const Floats dy = lane_y + block_y[block] - p.v;
      const int start = block_start(block);
      blend_block(tile->blocks + start / 16, start % 16, p, dx * dx + dy * dy, params);
    }
  }
  tile->live = still_live(tile, live, params);
  return tile->live != 0;
}

}  // namespace splat_kernel
}  // namespace ps
