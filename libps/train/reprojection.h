// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/train/dataset.h"

namespace ps::train {

/// @brief One view's pixels, found in another view.
struct Warped {
  Tensor color;   ///< [n, 3, h, w] what the partner shows there; its border where it is outside
  Tensor inside;  ///< [n, 1, h, w] 1 = in the partner's picture, and before its camera
};

/// @brief Lifts the view's pixels, moves them to the partner's camera and looks there (Zhou and
/// others, CVPR 2017, equation 2). Gradients reach the depth.
/// @param depth        [n, 1, h, w] metres
/// @param partner      [n, 3, h, w]
/// @param lens, partner_lens  [n, 4] fx, fy, cx, cy in pixels of pictures of h x w
/// @param partner_from_view   [n, 3, 4] R | t, metres
Warped warp(const Tensor& depth, const Tensor& partner, const Tensor& lens,
            const Tensor& partner_lens, const Tensor& partner_from_view);

/// @brief How pictures differ: 0.15 |a - b|, smoothed at 0, and 0.85 of the structural
/// dissimilarity (1 - SSIM) / 2 over 3x3 pixels (Godard and others, ICCV 2019, equation 2).
/// @param a, b  [n, 3, h, w] in [-1,1]   @return [n, 1, h, w], 0 = the same, at most about 1
Tensor photometric_error(const Tensor& a, const Tensor& b);

/// @brief How badly a depth explains the partner: the photometric error of what falls into it, at
/// three sizes of picture; how far the depth is from the best of a sweep of planes, where that
/// explains a pixel clearly better, which pulls the right way from any distance; and how rough the
/// depth is where the picture is not. Examples without pose give 0.
/// @param batch  with partners
/// @param depth  [n, 1, s, s] canonical metres of batch.plain
/// @return [n]
Tensor reprojection_loss(const Batch& batch, const Tensor& depth);

}  // namespace ps::train
