// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ps {

/// @brief A safetensors file that is not read but mapped: its bytes come from disk when they are
/// looked at, may be dropped again, and are shared by all processes that look at the same file.
/// A file that is made shorter meanwhile ends the process (SIGBUS); one that is replaced, as
/// write_safetensors() does it, does not.
class MappedSafetensors {
 public:
  struct Tensor {
    std::string dtype;  ///< as safetensors spells it
    std::vector<std::size_t> shape;
    const std::byte* data = nullptr;  ///< little-endian, row-major; aligned to its elements
  };

  /// Throws ps::Error as read_safetensors() does, and when a tensor is not aligned to its elements.
  explicit MappedSafetensors(const std::filesystem::path& path);
  ~MappedSafetensors();
  MappedSafetensors(MappedSafetensors&& other) noexcept;
  MappedSafetensors& operator=(MappedSafetensors&&) = delete;

  const std::map<std::string, Tensor>& tensors() const { return tensors_; }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
  std::map<std::string, Tensor> tensors_;
};

}  // namespace ps
