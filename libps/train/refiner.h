// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/train/parameters.h"

namespace ps::train {

/// @brief The refinement network in training (SPEC.md 8; `projector.*`; models::Refiner runs it).
/// Without spectral norm; its output is tanh(net + image).
class Refiner {
 public:
  static constexpr int kNoise = 20;

  Refiner(int g, std::uint64_t seed);
  Parameters parameters;

  /// @param input  [n, 4, h, w]: RGB in [-1,1], and 1 where it is a projection; sides multiples of
  /// 4
  /// @return [n, 3, h, w]
  Tensor forward(const Tensor& input, torch::Generator generator, bool training) const;

 private:
  Tensor noise_norm(const std::string& name, const Tensor& x, torch::Generator& generator,
                    bool training) const;
};

}  // namespace ps::train
