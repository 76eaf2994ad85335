// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room, for kernels alone: vectors as wide as the instruction set that a
// kernel is compiled for. C headers only; all is in an anonymous namespace, as each build has its
// own.
#pragma once

#include <stdint.h>

#if defined(__AVX2__) || defined(__SSE2__)
#include <immintrin.h>
#endif

namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 16;
#elif defined(__AVX2__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif

typedef float Lanes __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
typedef int32_t Marks __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

inline Lanes load(const float* p) { return *reinterpret_cast<const Lanes*>(p); }
inline Marks load(const int32_t* p) { return *reinterpret_cast<const Marks*>(p); }
inline void store(float* p, Lanes v) { *reinterpret_cast<Lanes*>(p) = v; }
inline Lanes all_lanes(float x) { return x - Lanes{}; }
inline Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }

/// @return whether any a is at most its b
inline bool any_at_most(Lanes a, Lanes b) {
#if defined(__AVX512F__)
  return _mm512_cmp_ps_mask(reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b), _CMP_LE_OQ) !=
         0;
#elif defined(__AVX2__)
  return _mm256_movemask_ps(reinterpret_cast<__m256>(a <= b)) != 0;
#elif defined(__SSE2__)
  return _mm_movemask_ps(reinterpret_cast<__m128>(a <= b)) != 0;
#else
  const Marks m = a <= b;
  return (m[0] | m[1] | m[2] | m[3]) != 0;
#endif
}

}  // namespace
