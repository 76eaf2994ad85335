// SPDX-License-Identifier: BSD-3-Clause
// Internal to kernels/: vectors of floats for the instruction set that the source is compiled for
// (PS_ISA), in an unnamed namespace, so that no instruction set can borrow another's code.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define PS_JOIN2(a, b) a##b
#define PS_JOIN(a, b) PS_JOIN2(a, b)
/// NAME becomes NAME_avx2, ...
#define PS_KERNEL(name) PS_JOIN(PS_JOIN(name, _), PS_ISA)

namespace ps::nn {
namespace {

#if defined(__AVX512F__)
constexpr int kVectorBytes = 64;
#elif defined(__AVX2__)
constexpr int kVectorBytes = 32;
#else
constexpr int kVectorBytes = 16;
#endif
constexpr int kLanes = kVectorBytes / 4;

typedef float Floats __attribute__((vector_size(kVectorBytes)));
typedef int32_t Ints __attribute__((vector_size(kVectorBytes)));

inline Floats load(const float* p) {
  Floats v;
  memcpy(&v, p, sizeof v);
  return v;
}
inline void store(float* p, Floats v) { memcpy(p, &v, sizeof v); }
inline Floats load_part(const float* p, int count) {  ///< zeros behind
  Floats v = {};
  memcpy(&v, p, static_cast<size_t>(count) * sizeof(float));
  return v;
}
inline void store_part(float* p, Floats v, int count) {
  memcpy(p, &v, static_cast<size_t>(count) * sizeof(float));
}
inline Floats all(float x) { return x - Floats{}; }

/// a * b + c, with one rounding where the instruction set has it
inline Floats multiply_add(Floats a, Floats b, Floats c) {
#if defined(__AVX512F__)
  return (Floats)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif defined(__FMA__)
  return (Floats)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
  return a * b + c;
#endif
}

/// x, or x * slope where it is negative
inline Floats activated(Floats x, Floats slope) { return x < 0.0f ? x * slope : x; }

}  // namespace
}  // namespace ps::nn
