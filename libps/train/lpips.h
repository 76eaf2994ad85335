// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "libps/train/parameters.h"

namespace ps::train {

/// @brief LPIPS over SqueezeNet (Zhang and others, CVPR 2018) as a loss: fixed weights, gradients
/// to the first image alone. models::Lpips is the same as a score.
class Lpips {
 public:
  /// @param weights  lpips_squeeze_v0.1.safetensors; throws ps::Error when a tensor is missing
  Lpips(const std::filesystem::path& weights, torch::Device device);

  /// @param a, b  [n, 3, h, w] in [-1,1]
  /// @return the mean over examples
  Tensor distance(const Tensor& a, const Tensor& b) const;

 private:
  std::vector<Tensor> features(const Tensor& image) const;
  Tensor convolution(const std::string& name, const Tensor& x, int stride, int padding) const;
  const Tensor& at(const std::string& name) const;

  TensorsByName weights_;
};

}  // namespace ps::train
