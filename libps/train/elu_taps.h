// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: what the PixelCNN's products read.
#pragma once

#include <torch/torch.h>

namespace ps::train {

constexpr int kTaps = 9;  ///< of a 3x3 convolution

/// @brief What the visible taps of each cell read, side by side, as a factor of a product. Its
/// gradient is gathered too: each cell is read through a tap by one cell at most.
/// @param x     [cells, c]
/// @param from  [9 cells], the cell that each tap of each cell reads; below 0 = none, zeros
/// @param to    [9 cells], for each cell, the 9 tap numbers (cell * 9 + tap) that read it
/// @return [cells, 9 c]
/// These three throw c10::Error as torch does.
torch::Tensor gathered_taps(const torch::Tensor& x, const torch::Tensor& from,
                            const torch::Tensor& to);

/// @brief ELU of x and of -x (Salimans and others, PixelCNN++, ICLR 2017, after Shang and others,
/// ICML 2016), side by side: [cells, 2 c], as a factor of a product.
torch::Tensor concat_elu(const torch::Tensor& x);

/// @brief gathered_taps(concat_elu(x), from, to). Where products are narrow and x is of float on
/// the CPU, concat_elu() is one pass each way, with one exponential for each value, and the
/// gradient of elu_taps() is one pass. They have no second derivatives then.
torch::Tensor elu_taps(const torch::Tensor& x, const torch::Tensor& from, const torch::Tensor& to);

}  // namespace ps::train
