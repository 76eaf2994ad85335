// SPDX-License-Identifier: BSD-3-Clause
// Internal to the nn room: 3x3 convolutions with a quarter of the multiplications.
#pragma once

#include <memory>
#include <vector>

#include "libps/nn/convolution.h"

namespace ps::nn {

/// The weights of a 3x3 convolution at the 36 products of F(4x4, 3x3).
struct WinogradWeights {
  std::vector<PackedMatrix> products;  ///< [36], each in x out
};

/// @param weight  [out, in, 3, 3]
std::unique_ptr<WinogradWeights> winograd_weights(const WeightTensor& weight, Storage storage);

/// @brief out = the convolution of `in` with `padding` zeros around, as Convolution says. Shapes
/// fit.
void winograd_convolution(const WinogradWeights& weights, const TensorView& in, int padding,
                          const TensorView& out, const Epilogue& epilogue,
                          const Prologue& prologue);

}  // namespace ps::nn
