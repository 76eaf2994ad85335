// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: leaky ReLU.
#pragma once

#include <torch/torch.h>

namespace ps::train {

/// @brief torch::leaky_relu(x, slope). Where x is of bfloat16 on the CPU, in one pass forward and
/// one back, digit for digit what is computed in float and then rounded. It has no second
/// derivatives then.
/// @param x  [n, c, h, w], of any layout
/// Throws c10::Error as torch does.
torch::Tensor leaky(const torch::Tensor& x, float slope);

}  // namespace ps::train
