// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "libps/nn/packed_matrix.h"
#include "libps/nn/weights.h"

namespace ps::nn {

/// @brief torch.nn.ConvTranspose2d, kernel 4x4, stride 2, padding 1: twice the size. Each of the
/// four places of a 2x2 block of outputs is a convolution of 2x2 taps.
class TransposedConvolution {
 public:
  /// @param weight  [in, out, 4, 4]
  /// Throws ps::Error when the shape is another.
  TransposedConvolution(const WeightTensor& weight, std::vector<float> bias,
                        Storage storage = Storage::f32);

  int in_channels() const { return matrices_[0].depth(); }
  int out_channels() const { return matrices_[0].columns(); }
  Shape output(const Shape& in) const {
    return {in.images, 2 * in.height, 2 * in.width, out_channels()};
  }

  /// Throws ps::Error when shapes do not fit. `out` must not overlap `in`.
  void operator()(const TensorView& in, const TensorView& out, const Epilogue& epilogue = {}) const;

 private:
  std::vector<float> bias_;
  std::array<PackedMatrix, 4> matrices_;  ///< of output (2y + i, 2x + j): index 2 i + j
};

}  // namespace ps::nn
