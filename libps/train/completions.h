// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/nn/weights.h"
#include "libps/train/parameters.h"

namespace ps::train {

/// @brief A network's tensors as they are now, for libps/models to read.
nn::Weights weights_of(const Parameters& parameters);

/// @brief Completions of one view's codes by the program's own sampler (outpaint::Sampler, its
/// default temperature, seed 0; without guidance).
/// @param pixel_cnn  of PixelCnn
/// @param codes      [h, w] int64, of what is seen
/// @param order      [h * w] int64: cells from first to last
/// @param unseen     [h * w] 1 = a cell to be sampled
/// @return [count, h, w] int64
Tensor completions(const Parameters& pixel_cnn, const Tensor& codes, const Tensor& order,
                   const Tensor& unseen, int count);

}  // namespace ps::train
