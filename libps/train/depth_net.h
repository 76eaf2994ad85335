// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/train/parameters.h"

namespace ps::train {

/// @brief The depth U-Net in training (SPEC.md 3; `pts_regressor.*`; models::DepthNet runs it).
/// Without spectral norm: batch norms follow nearly all of its convolutions.
class DepthNet {
 public:
  DepthNet(int f, std::uint64_t seed);
  Parameters parameters;

  /// @param image  [n, 3, h, w] in [-1,1], sides multiples of 256
  /// @return [n, 1, h, w], raw
  Tensor forward(const Tensor& image, bool training) const;
};

}  // namespace ps::train
