// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: a shard (shard.h) as tensors.
#pragma once

#include <torch/torch.h>

#include <filesystem>

#include "io/mapped_safetensors.h"

namespace ps::train {

using torch::Tensor;

/// The fields of shard.h.
struct ShardTensors {
  explicit ShardTensors(const std::filesystem::path& path) : file(path) {}

  Tensor color, depth, focal, kind, splat, flags, order;
  Tensor lens, pose;   ///< of old shards: what harms no arithmetic
  bool posed = false;  ///< whether lens and pose are in the file

  MappedSafetensors file;  ///< what they borrow; never written to
};

/// @brief Maps a shard: of 5 GB of examples, memory holds what was looked at of late, once for all
/// trainings. Throws ps::Error when a field is missing, of another kind or shape, or a pose or a
/// lens is unsound.
ShardTensors read_shard(const std::filesystem::path& path);

}  // namespace ps::train
