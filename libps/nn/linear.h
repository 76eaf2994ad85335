// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/nn/packed_matrix.h"
#include "libps/nn/weights.h"

namespace ps::nn {

/// @brief torch.nn.Linear over the channels of every pixel: out = W in + bias.
class Linear {
 public:
  /// @param weight  [out, in]
  Linear(const WeightTensor& weight, std::vector<float> bias, Storage storage = Storage::f32);

  const PackedMatrix& matrix() const { return matrix_; }
  const std::vector<float>& bias() const { return bias_; }

  /// Throws ps::Error when shapes do not fit. `out` must not overlap `in`.
  void operator()(const TensorView& in, const TensorView& out, const Epilogue& epilogue = {}) const;

 private:
  std::vector<float> bias_;
  PackedMatrix matrix_;
};

}  // namespace ps::nn
