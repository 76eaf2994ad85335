// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "libps/rooms/shot.h"

namespace ps::rooms {

/// @brief What a real camera adds. Each is a largest strength; 0 turns the effect off. The
/// strength used is random, and an effect is left out now and then.
struct EffectOptions {
  float exposure = 0.7f;        ///< stops, either way
  float white_balance = 0.15f;  ///< share of gain of red and blue, either way
  float vignetting = 0.35f;     ///< light lost in the corners
  float contrast = 0.4f;        ///< gamma and S curve
  float saturation = 0.35f;     ///< share, either way
  float blur = 1.0f;            ///< pixels, sigma; also short motion blur
  float sharpening = 0.8f;      ///< halo, share
  float noise = 0.03f;          ///< sigma, of [0,1], in the dark
  float jpeg = 0.7f;            ///< 8x8 DCT quantisation, 1 = coarse
};

/// @brief Degrades the colour as cameras do; depth stays as it is. A function of (shot, seed,
/// options) alone. Throws ps::Error for a shot whose sizes do not agree.
void degrade(Shot& shot, std::uint64_t seed, const EffectOptions& options = {});

}  // namespace ps::rooms
