// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "libps/nn/packed_matrix.h"
#include "libps/nn/weights.h"

namespace ps::nn {

/// @brief Locally masked convolution, 3x3, stride 1 (Jain, Abbeel, Pathak 2020; SPEC.md 7):
/// out(i) = bias + sum over taps k of mask(k, i) W_k in(i + offset_k), zeros outside the image.
class MaskedConvolution {
 public:
  /// @param weight  [out, in, 3, 3]
  MaskedConvolution(const WeightTensor& weight, std::vector<float> bias, int dilation = 1,
                    Storage storage = Storage::f32);

  const PackedMatrix& matrix() const { return matrix_; }
  const std::vector<float>& bias() const { return bias_; }
  int dilation() const { return dilation_; }

  /// @param mask  [9][height * width], not 0 = visible, the same for all images; taps row by row
  /// Throws ps::Error when shapes do not fit. `out` must not overlap `in`.
  void operator()(const TensorView& in, const std::uint8_t* mask, const TensorView& out,
                  const Epilogue& epilogue = {}) const;

 private:
  std::vector<float> bias_;
  int dilation_ = 1;
  PackedMatrix matrix_;
};

}  // namespace ps::nn
