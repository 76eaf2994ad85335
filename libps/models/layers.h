// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: layers by name, and checks of shapes.
#pragma once

#include <string>

#include "libps/models/model_options.h"
#include "libps/nn/convolution.h"
#include "libps/nn/linear.h"
#include "libps/nn/transposed_convolution.h"
#include "libps/nn/weights.h"

namespace ps::models {

/// What a convolution's weights must look like, and how it steps.
struct ConvolutionSpec {
  int in = 0, out = 0;  ///< channels; 0 = as the weights have it
  int kernel = 3;
  int stride = 1;
  int padding = 0;
  bool bias = true;  ///< whether it has one
};

/// @brief Makes the layers of one network from the weights whose names begin with a prefix.
class Layers {
 public:
  /// @param prefix  with its dot
  Layers(const nn::Weights& weights, std::string prefix, const ModelOptions& options)
      : weights_(weights), prefix_(std::move(prefix)), options_(options) {}

  /// @param norm   name of a BatchNorm that follows at once and is folded into the weights; or ""
  /// @param added  what is added to the bias, before the norm; or none
  nn::Convolution convolution(const std::string& name, const ConvolutionSpec& spec,
                              const std::string& norm = "",
                              const std::vector<float>& added = {}) const;
  nn::TransposedConvolution transposed(const std::string& name, int in, int out) const;
  nn::Linear linear(const std::string& name, int in, int out) const;

  /// @brief A layer's weight, spectral or weight norm applied; axes of 0 may be anything.
  nn::WeightTensor weight(const std::string& name, const std::vector<int>& shape) const;
  /// @brief A tensor as it stands in the file; axes of 0 may be anything.
  nn::WeightTensor tensor(const std::string& name, const std::vector<int>& shape) const;
  std::vector<float> vector(const std::string& name, int count) const;
  std::vector<float> variance(const std::string& name, int count) const;  ///< none is negative

 private:
  const nn::Weights& weights_;
  std::string prefix_;
  ModelOptions options_;
};

/// @return an epilogue that does this alone
nn::Epilogue activated(nn::Activation activation);

/// @brief Throws ps::Error unless the view has this shape.
void check_shape(const char* network, const char* tensor, const nn::TensorView& view,
                 const nn::Shape& expected);

/// @brief Throws ps::Error unless the view has so many channels, at least one pixel to each image,
/// and sides that are multiples of `multiple`.
void check_image(const char* network, const nn::TensorView& view, int channels, int multiple);

}  // namespace ps::models
