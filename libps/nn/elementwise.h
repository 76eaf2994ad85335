// SPDX-License-Identifier: BSD-3-Clause
// Operators that treat every value by itself. `out` may be `in`. All throw ps::Error when shapes do
// not fit. exp, tanh and sigmoid are within 3 units in the last place of 1 (3e-7) of the exact
// value, and do the same operations for a value wherever it stands.
#pragma once

#include "libps/nn/activation.h"
#include "libps/nn/tensor.h"

namespace ps::nn {

void activate(const TensorView& in, const TensorView& out, Activation activation);

/// @brief torch elu, alpha 1: x, or exp(x) - 1 where x is negative.
void elu(const TensorView& in, const TensorView& out);

/// @brief elu of [x, -x]: twice the channels (Salimans and others, PixelCNN++). `out` must not
/// overlap `in`.
void concat_elu(const TensorView& in, const TensorView& out);

void tanh(const TensorView& in, const TensorView& out);
void sigmoid(const TensorView& in, const TensorView& out);

/// @brief activation(x * scale + shift), with a scale and a shift for each channel.
void scale_shift(const TensorView& in, const float* scale, const float* shift,
                 const TensorView& out, Activation activation = {});

void add(const TensorView& a, const TensorView& b, const TensorView& out,
         Activation activation = {});

/// @brief out = base + value * sigmoid(gate): the end of a gated block (SPEC.md 7).
void gated_add(const TensorView& base, const TensorView& value, const TensorView& gate,
               const TensorView& out);

}  // namespace ps::nn
