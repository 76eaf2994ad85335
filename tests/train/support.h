// SPDX-License-Identifier: BSD-3-Clause
// What tests of training share.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "io/safetensors.h"
#include "libps/core/error.h"
#include "libps/train/train.h"

namespace ps::train {

/// A folder of shards that goes away.
class ShardFolder {
 public:
  explicit ShardFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("ps_" + name + "_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~ShardFolder() { remove(); }
  ShardFolder(const ShardFolder&) = delete;
  ShardFolder& operator=(const ShardFolder&) = delete;

  void remove() const { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, const TensorMap& shard) const {
    write_safetensors(path_ / (name + ".safetensors"), shard);
  }

 private:
  std::filesystem::path path_;
};

/// What the ps::Error of a call says; empty when there was none.
template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline std::string message_of(const TrainOptions& options) {
  return error_of([&] { train(options, {}); });
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace ps::train
