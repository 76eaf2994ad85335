// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: how tensors lie in memory.
#pragma once

#include <torch/torch.h>

namespace ps::train {

/// @return x, channels last: what our loops and oneDNN's convolutions read in one run
inline torch::Tensor channels_last(const torch::Tensor& x) {
  return x.contiguous(torch::MemoryFormat::ChannelsLast);
}

/// @return whether our loops over float can read x
inline bool is_float_on_cpu(const torch::Tensor& x) {
  return x.is_cpu() && x.scalar_type() == torch::kFloat32;
}

/// @return whether our loops over bfloat16 can read x
inline bool is_narrow_on_cpu(const torch::Tensor& x) {
  return x.is_cpu() && x.scalar_type() == torch::kBFloat16;
}

}  // namespace ps::train
