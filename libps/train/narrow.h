// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: what loops over bfloat16 have in common.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__x86_64__) && defined(__GNUC__) && defined(__GLIBC__)
/// Built for several vector widths, of which the processor picks one; all give the same digits.
#define PS_ANY_WIDTH __attribute__((target_clones("avx2", "default")))
#else
#define PS_ANY_WIDTH
#endif

namespace ps::train {

/// @return whether this thread's products are narrow now, by the innermost NarrowProducts
bool products_are_narrow();

/// A bfloat16 by its bits.
using Narrow = std::uint16_t;

inline float widened(Narrow x) {
  const std::uint32_t bits = static_cast<std::uint32_t>(x) << 16;
  float wide;
  std::memcpy(&wide, &bits, sizeof wide);
  return wide;
}

/// The nearest bfloat16, the even one of two; NaN stays NaN.
inline Narrow narrowed(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::uint32_t rounded = (bits + 0x7fffu + (bits >> 16 & 1)) >> 16;
  return static_cast<Narrow>((bits & 0x7fffffffu) > 0x7f800000u ? 0x7fc0u : rounded);
}

/// first ? a : b without a branch, which keeps a loop from being turned into vectors.
inline float chosen(bool first, float a, float b) {
  std::uint32_t x, y;
  std::memcpy(&x, &a, sizeof x);
  std::memcpy(&y, &b, sizeof y);
  const std::uint32_t mask = -static_cast<std::uint32_t>(first), bits = (x & mask) | (y & ~mask);
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace ps::train
