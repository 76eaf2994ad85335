// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: twice the width and height.
#pragma once

#include <torch/torch.h>

namespace ps::train {

/// @brief torch::upsample_bilinear2d to twice the size, align_corners = false; with gradients. On
/// the CPU it is our own loop over memory, where libtorch 1.13 takes six times as long as memory.
/// @param x  [n, c, h, w] of float
/// @return channels last where x is
torch::Tensor upsample_2x(const torch::Tensor& x);

}  // namespace ps::train
