// SPDX-License-Identifier: BSD-3-Clause
// What tests of training share.
#pragma once

#include <string>

#include "io/safetensors.h"
#include "libps/train/train.h"
#include "tests/io/support.h"

namespace ps::train {

inline void write_shard(const Folder& folder, const std::string& name, const TensorMap& shard) {
  write_safetensors(folder / (name + ".safetensors"), shard);
}

inline std::string message_of(const TrainOptions& options) {
  return error_of([&] { train(options, {}); });
}

}  // namespace ps::train
