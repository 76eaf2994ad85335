// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set (PS_ISA). C headers only: nothing inline may be shared.
#include "libps/geometry/splat_kernel.h"

#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define PS_JOIN2(a, b) a##b
#define PS_JOIN(a, b) PS_JOIN2(a, b)

namespace ps {
namespace splat_kernel {
namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 16;
#elif defined(__AVX2__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif
constexpr int kVectorsInRow = kTile / kLanes;

typedef float Floats __attribute__((vector_size(4 * kLanes), may_alias));
typedef int32_t Ints __attribute__((vector_size(4 * kLanes), may_alias));

inline Floats square_root(Floats x) {
#if defined(__AVX512F__)
  return (Floats)_mm512_sqrt_ps((__m512)x);
#elif defined(__AVX2__)
  return (Floats)_mm256_sqrt_ps((__m256)x);
#elif defined(__SSE2__)
  return (Floats)_mm_sqrt_ps((__m128)x);
#else
  for (int i = 0; i < kLanes; ++i) x[i] = __builtin_sqrtf(x[i]);
  return x;
#endif
}

inline Floats& floats(float* p) { return *reinterpret_cast<Floats*>(p); }
inline Ints& ints(int32_t* p) { return *reinterpret_cast<Ints*>(p); }

inline int clamp_int(float x, int low, int high) {
  return x < low ? low : x > high ? high : static_cast<int>(x);
}

/// SPEC.md 4: alpha = 1 - sqrt(clamp(d^2 / r^2, 1e-3, 1)); a hit is strictly inside the radius.
inline void blend_vector(Tile* tile, int at, const TilePoint& p, Floats dx2, float dy2, float r2,
                         float inverse_r2, const Params& params) {
  const Floats d2 = dx2 + dy2;
  Floats& left = floats(tile->left + at);
  Ints& count = ints(tile->count + at);
  const Ints hit = (d2 < r2) & (left >= params.enough) & (count < params.most_hits);
  const Floats zero = {};
  const Floats share = d2 * inverse_r2;
  const Floats alpha = 1.0f - square_root(share < 1e-3f ? zero + 1e-3f : share);
  const Floats weight = hit ? alpha * left : zero;
  Floats& first = floats(tile->first + at);
  first = (hit & (count == 0)) ? zero + p.z : first;
  count -= hit;
  left -= weight;
  floats(tile->r + at) += weight * p.r;
  floats(tile->g + at) += weight * p.g;
  floats(tile->b + at) += weight * p.b;
  floats(tile->z + at) += weight * p.z;
}

inline void blend_point(Tile* tile, const TilePoint& p, const Floats* x, float inverse_r2,
                        const Params& params) {
  const float r = params.radius, r2 = r * r;
  const int row_first = clamp_int(p.v - r - params.y0, 0, kTile - 1);
  const int row_last = clamp_int(p.v + r - params.y0 + 1, 0, kTile - 1);
  const int vector_first = clamp_int(p.u - r - params.x0, 0, kTile - 1) / kLanes;
  const int vector_last = clamp_int(p.u + r - params.x0 + 1, 0, kTile - 1) / kLanes;
  for (int k = vector_first; k <= vector_last; ++k) {
    const Floats dx = x[k] - p.u;
    const Floats dx2 = dx * dx;
    for (int row = row_first; row <= row_last; ++row) {
      if (!tile->live[row * kVectorsInRow + k]) continue;
      const float dy = params.y0 + static_cast<float>(row) - p.v;
      blend_vector(tile, row * kTile + k * kLanes, p, dx2, dy * dy, r2, inverse_r2, params);
    }
  }
}

bool update_live(Tile* tile, const Params& params) {
  bool any = false;
  for (int vector = 0; vector < kTile * kVectorsInRow; ++vector) {
    if (!tile->live[vector]) continue;
    const Ints can = (floats(tile->left + vector * kLanes) >= params.enough) &
                     (ints(tile->count + vector * kLanes) < params.most_hits);
    int32_t lanes[kLanes];
    memcpy(lanes, &can, sizeof lanes);
    int32_t either = 0;
    for (int i = 0; i < kLanes; ++i) either |= lanes[i];
    tile->live[vector] = either != 0;
    any |= either != 0;
  }
  return any;
}

}  // namespace

bool PS_JOIN(blend_, PS_ISA)(Tile* tile, const TilePoint* points, int count, const Params& params) {
  Floats x[kVectorsInRow];
  for (int i = 0; i < kTile; ++i) {
    x[i / kLanes][i % kLanes] = params.x0 + static_cast<float>(i);
  }
  const float inverse_r2 = 1.0f / (params.radius * params.radius);
  for (int i = 0; i < count; ++i) blend_point(tile, points[i], x, inverse_r2, params);
  return update_live(tile, params);
}

}  // namespace splat_kernel
}  // namespace ps
