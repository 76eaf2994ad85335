// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: a convolution, and the batch norm and leaky ReLU after it.
#pragma once

#include <string>

#include "libps/train/parameters.h"

namespace ps::train {

/// @brief convolution(), unless `norm` is empty batch_norm() of what it gives, and leaky() of that.
/// Where products are narrow, in training on the CPU, what it gives is bfloat16, too: the norm
/// reads the values that the product wrote, with sums in double, and nothing is copied to float and
/// back, forwards or backwards. Values differ from batch_norm()'s by rounding alone, whatever the
/// number of threads. It has no second derivatives then.
/// @param x      [n, c, h, w], of any layout
/// @param slope  of what is below 0; 1 = no leaky ReLU
/// @return bfloat16 then, else float
/// Throws ps::Error when there is no tensor of such a name, c10::Error as torch does.
Tensor normed_convolution(const Parameters& p, const std::string& name, const std::string& norm,
                          const Tensor& x, int stride, int padding, float slope, bool training);

/// @brief The norm and the leaky ReLU alone.
/// @param x  [n, c, h, w] of bfloat16 on the CPU; the rest [c] of float, the running ones moved
/// @return bfloat16, channels last
/// Throws c10::Error when x is of another type.
Tensor narrow_batch_norm(const Tensor& x, const Tensor& weight, const Tensor& bias,
                         const Tensor& running_mean, const Tensor& running_var, float slope = 1);

}  // namespace ps::train
