// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: what camera effects do to rows of RGB floats, built for several
// vector widths. Every width does the same operations in the same order: same bytes.
#pragma once

#include <stdint.h>

namespace ps {
namespace rooms {
namespace effects_kernel {

/// Gains of red, green and blue times `light` of each pixel, then saturation; all within [0, 1].
typedef void Tint(float* rgb, const float* light, const float* gains, float saturation, int pixels);

/// out[i] = the sum of weights[t] * taps[t][i], over `total`.
typedef void Weigh(const float* const* taps, const float* weights, int count, float total,
                   float* out, int floats);

constexpr int kStreams = 16;  ///< numbers that are drawn at a time

/// A congruential generator whose next kStreams states are known; `leap` and `add` take each to the
/// state that many later.
struct Streams {
  uint64_t state[kStreams];
  uint64_t leap, add;
};
/// Adds noise of about N(0, sigma), less where it is light: four numbers for a pixel, one of all
/// channels, then one for each; `colored` is the share of the latter.
typedef void Grain(Streams* streams, float* rgb, float sigma, float colored, int pixels);

/// Luma, blue - luma and red - luma of pixels, and back, within [0, 1].
typedef void Part(const float* rgb, float* luma, float* blue, float* red, int pixels);
typedef void Join(const float* luma, const float* blue, const float* red, float* rgb, int pixels);

/// The cosine transform of 8x8 numbers, each rounded to a multiple of its step, and back.
/// @param block   eight rows, `stride` apart
/// @param basis   [frequency][place]
/// @param inverse  [place][frequency], the same
typedef void Quantise(float* block, int stride, const float* basis, const float* inverse,
                      const float* steps);

Tint tint_baseline, tint_avx2, tint_avx512;
Weigh weigh_baseline, weigh_avx2, weigh_avx512;
Grain grain_baseline, grain_avx2, grain_avx512;
Part part_baseline, part_avx2, part_avx512;
Join join_baseline, join_avx2, join_avx512;
Quantise quantise_baseline, quantise_avx2, quantise_avx512;

}  // namespace effects_kernel
}  // namespace rooms
}  // namespace ps
