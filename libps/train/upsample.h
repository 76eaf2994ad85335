// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: twice the width and height.
#pragma once

#include <torch/torch.h>

namespace ps::train {

/// Of a pixel of twice the size, from the two that it lies between along an axis.
constexpr float kNear = .75F, kFar = .25F;

/// @brief torch::upsample_bilinear2d to twice the size, align_corners = false; with gradients. Of
/// float on the CPU it is our own loop: libtorch 1.13's takes 56 ms for the gradient of
/// 8x32x256x256 values on one core. It has no second derivatives.
/// @param x  [n, c, h, w], of any layout
/// @return [n, c, 2 h, 2 w]; of float on the CPU always channels last, else as torch has it
/// Throws c10::Error as torch does.
torch::Tensor upsample_2x(const torch::Tensor& x);

/// @brief as_factor(upsample_2x(torch::relu(x))). Where x is of bfloat16 on the CPU, in one pass
/// forward and one back, digit for digit what is blended in float and then rounded. It has no
/// second derivatives then.
/// @param x  [n, c, h, w], of any layout
/// @return [n, c, 2 h, 2 w]
/// Throws c10::Error as torch does.
torch::Tensor relu_upsample_2x(const torch::Tensor& x);

}  // namespace ps::train
