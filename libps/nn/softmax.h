// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/nn/tensor.h"

namespace ps::nn {

/// @brief softmax(x / temperature) over the channels of every pixel. `out` may be `in`.
/// Throws ps::Error when shapes differ or the temperature is not more than 0.
void softmax(const TensorView& in, const TensorView& out, float temperature = 1);

}  // namespace ps::nn
