// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: loops over the pixels of a picture, built for several vector widths.
// Every width does the same operations in the same order: same bytes.
#pragma once

#include <stdint.h>

namespace ps {
namespace rooms {
namespace plane_kernel {

constexpr int kStep = 16;

/// A stretch of a row: three planes of floats, and the number of the surface each pixel is of.
struct Stretch {
  const float* value[3];
  const int32_t* surface;
};

/// Means of pixels of one surface, `count` pixels on; up to a multiple of kStep pixels are read and
/// written.
/// @param taps  five stretches, the middle one that of the pixels themselves: weights are
/// 1/2, 1, 1, 1, 1/2
typedef void Share(const Stretch* taps, float* const* out, int count);
/// Means over three stretches; the two outer ones weigh the less the more their light differs.
typedef void ShareAlike(const Stretch* taps, float* const* out, int count);

/// A function by table: values at 0, step, 2 step, ..., straight between.
struct Curve {
  const float* values;
  int steps;   ///< one less than there are values
  float most;  ///< where the last value is
  bool root;   ///< steps are even along the root of x
};
/// out[i] = curve(in[i]), of x cut to [0, most); `in` may be `out`.
typedef void Look(const Curve& curve, const float* in, float* out, int count);

Share share_baseline, share_avx2, share_avx512;
ShareAlike share_alike_baseline, share_alike_avx2, share_alike_avx512;
Look look_baseline, look_avx2, look_avx512;

}  // namespace plane_kernel
}  // namespace rooms
}  // namespace ps
