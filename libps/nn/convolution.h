// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "libps/nn/packed_matrix.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"

namespace ps::nn {

struct WinogradWeights;

/// How a convolution is computed.
enum class Method {
  automatic,  ///< winograd from 16 channels and images of 256 pixels on (the README's chart says
              ///< why)
  direct,
  winograd,  ///< F(4x4, 3x3); 3x3 with stride and dilation 1 alone, others stay direct
};

struct ConvolutionOptions {
  int stride = 1;
  int padding = 0;  ///< zeros on each side
  int dilation = 1;
  Method method = Method::automatic;
  Storage storage = Storage::f32;
};

/// @brief What may be done to the input of a convolution as it is read: relu(x * scale + shift),
/// for each channel; zeros of the padding stay zeros. Both, with a value for each input channel, or
/// neither.
struct Prologue {
  const float* scale = nullptr;
  const float* shift = nullptr;
};

/// @brief torch.nn.Conv2d (groups 1) over channels-last tensors.
class Convolution {
 public:
  /// @param weight  [out, in, height, width], square kernels
  /// @param bias    `out` values, or none
  /// Throws ps::Error when the weight's shape or an option makes no sense.
  Convolution(const WeightTensor& weight, std::vector<float> bias,
              const ConvolutionOptions& options = {});
  ~Convolution();
  Convolution(Convolution&&) noexcept;
  Convolution& operator=(Convolution&&) noexcept;

  int in_channels() const { return in_; }
  int out_channels() const { return out_; }
  /// @return the shape that an input of this shape becomes; 0 pixels when the kernel does not fit
  Shape output(const Shape& in) const;
  std::size_t bytes() const;

  /// @param epilogue  its bias is this convolution's own and must be null
  /// @param prologue  needs scratch of the input's size, except with Winograd
  /// Throws ps::Error when shapes do not fit. `out` must not overlap `in`.
  void operator()(const TensorView& in, const TensorView& out, Workspace& workspace,
                  const Epilogue& epilogue = {}, const Prologue& prologue = {}) const;

 private:
  void direct(const TensorView& in, const TensorView& out, const Epilogue& epilogue) const;

  ConvolutionOptions options_;
  int kernel_ = 1, in_ = 0, out_ = 0;
  std::vector<float> bias_;
  PackedMatrix matrix_;
  std::unique_ptr<WinogradWeights> winograd_;
};

}  // namespace ps::nn
