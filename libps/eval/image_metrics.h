// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/core/image.h"

namespace ps {

/// @brief Peak signal-to-noise ratio in dB of two RGB images in [0,1], over the pixels where
/// `where` is not 0 (empty = all). Infinite when they are equal there; NaN when no pixel is chosen.
/// Throws ps::Error when sizes differ.
double psnr(const Image& a, const Image& b, const Mask& where = {});

/// @brief Structural similarity of the grey images (Wang et al., IEEE TIP 2004: 11x11 Gaussian
/// window, sigma 1.5, K = 0.01, 0.03), mean over the pixels where `where` is not 0 (empty = all).
///
/// As in the paper's own program, only windows that lie inside the image count: pixels nearer than
/// 5 to an edge are left out. Windows look beyond the mask. Grey is 0.299 R + 0.587 G + 0.114 B.
/// NaN when no pixel is left. Throws ps::Error when sizes differ.
double ssim(const Image& a, const Image& b, const Mask& where = {});

}  // namespace ps
