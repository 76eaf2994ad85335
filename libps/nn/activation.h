// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ps::nn {

/// @brief What is applied to a value before it is stored: the value itself, or value * slope where
/// it is negative. slope 1 = nothing, 0 = ReLU, 0.2 = the published leaky ReLU.
struct Activation {
  float slope = 1;
};

constexpr Activation kRelu = {0};
constexpr Activation kLeakyRelu = {0.2f};

}  // namespace ps::nn
