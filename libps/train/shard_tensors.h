// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: a shard (shard.h) as tensors.
#pragma once

#include <torch/torch.h>

#include <filesystem>

#include "io/safetensors.h"

namespace ps::train {

using torch::Tensor;

/// The fields of shard.h.
struct ShardTensors {
  Tensor color, depth, focal, kind, splat, flags, order;
  Tensor lens, pose;   ///< of old shards: what harms no arithmetic
  bool posed = false;  ///< whether lens and pose are in the file

  TensorMap file;  ///< what they borrow
};

/// @brief Throws ps::Error when a field is missing, of another kind or shape, or a pose or a lens
/// is unsound.
ShardTensors read_shard(const std::filesystem::path& path);

}  // namespace ps::train
