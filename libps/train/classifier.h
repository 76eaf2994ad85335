// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/train/parameters.h"

namespace ps::train {

/// @brief ResNet-18 in training (`classifier.*`; models::Classifier runs it).
class Classifier {
 public:
  Classifier(int width, int classes, std::uint64_t seed);
  Parameters parameters;

  /// @param image  [n, 3, h, w] in [-1,1]; it is shifted and scaled by ImageNet's means and
  /// deviations here
  /// @return logits [n, classes]
  Tensor forward(const Tensor& image, bool training) const;

 private:
  Tensor block(const std::string& name, const Tensor& x, int stride, bool training) const;
};

}  // namespace ps::train
