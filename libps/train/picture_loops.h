// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: how pictures are cropped, mirrored and tinted, in few passes.
#pragma once

#include <torch/torch.h>

namespace ps::train {

/// @brief torch::grid_sampler of an upright square: theta is [[sx, 0, tx], [0, sy, ty]] of each
/// picture, which maps -1..1 of the result into -1..1 of the picture (align_corners = false);
/// what lies outside is the border's. Of float on the CPU it is our own loop, without gradients.
/// @param image    [n, c, h, w] of any layout
/// @param theta    [n, 2, 3] of float on the CPU; else throws c10::Error
/// @param nearest  else bilinear
/// @return as image, channels last
torch::Tensor sampled_upright(const torch::Tensor& image, const torch::Tensor& theta, bool nearest);

/// How each picture's colours are changed, one after another; of [n, 1, 1, 1] but for tint.
struct Tints {
  torch::Tensor gamma;       ///< the exponent
  torch::Tensor gain;        ///< of all channels
  torch::Tensor tint;        ///< [n, 3, 1, 1] of each
  torch::Tensor saturation;  ///< of what differs from grey
  torch::Tensor contrast;    ///< of what differs from the picture's mean
};

/// @brief Of float on the CPU by our own loops, without gradients.
/// @param color  [n, 3, h, w] in [-1, 1]
/// @return as color, in [-1, 1], channels last
torch::Tensor tinted(const torch::Tensor& color, const Tints& tints);
/// @brief The same by libtorch's operators alone, on any device.
torch::Tensor tinted_by_operators(const torch::Tensor& color, const Tints& tints);

}  // namespace ps::train
