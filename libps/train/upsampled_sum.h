// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: a convolution to one channel after upsampling.
#pragma once

#include <torch/torch.h>

namespace ps::train {

/// @brief The 3x3 convolution, padded by zeros, of relu_upsample_2x(x) to a single channel. Of
/// bfloat16 on the CPU the nine products of a pixel's channels come first, at the small size, and
/// are upsampled and added up in float after: blending is linear and does not mind, and oneDNN
/// otherwise pads the one channel to sixteen, which was a third of the time of a depth network's
/// convolutions. It has no second derivatives then.
/// @param x       [n, c, h, w]
/// @param weight  [1, c, 3, 3]
/// @param bias    [1]
/// @return float, [n, 1, 2 h, 2 w]
/// Throws c10::Error as torch does.
torch::Tensor relu_upsample_to_one(const torch::Tensor& x, const torch::Tensor& weight,
                                   const torch::Tensor& bias);

}  // namespace ps::train
