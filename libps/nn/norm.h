// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/nn/activation.h"
#include "libps/nn/tensor.h"

namespace ps::nn {

/// @brief torch.nn.InstanceNorm2d without affine: for each image and channel, (x - mean) / sqrt(var
/// + 1e-5) over its pixels, biased variance. Sums are of double precision, in a fixed order. `out`
/// may be `in`. Throws ps::Error when shapes differ.
void instance_norm(const TensorView& in, const TensorView& out, Activation activation = {});

/// @brief Positional norm (SPEC.md 7): for each pixel, (x - mean) / sqrt(var + 1e-5) over its
/// channels, unbiased variance (of one channel: 0). `out` may be `in`. Throws ps::Error when shapes
/// differ.
void positional_norm(const TensorView& in, const TensorView& out);

}  // namespace ps::nn
