// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ps {

/// @brief A tensor in a file: little-endian bytes, row-major.
struct FileTensor {
  std::string dtype;  ///< as safetensors spells it: F32, F16, BF16, F64, I32, I64, U8, BOOL, ...
  std::vector<std::size_t> shape;
  std::vector<std::byte> bytes;

  std::size_t elements() const;
  /// @return the values as float, from F32, F16, BF16, F64, I32, I64, U8 or BOOL; throws otherwise
  std::vector<float> as_floats() const;

  static FileTensor of(const std::vector<float>& values, std::vector<std::size_t> shape);
  static FileTensor of(const std::vector<std::int32_t>& values, std::vector<std::size_t> shape);
  static FileTensor of(const std::vector<std::uint8_t>& values, std::vector<std::size_t> shape);
};

using TensorMap = std::map<std::string, FileTensor>;

/// @brief Reads a safetensors file (huggingface/safetensors, "Format"). Throws ps::Error when the
/// header is unsound, offsets overlap or overrun, sizes disagree with shapes, or the file is too short.
TensorMap read_safetensors(const std::filesystem::path& path);

/// @brief Writes all tensors, by name order, data aligned to 8 bytes. Whole or not at all.
void write_safetensors(const std::filesystem::path& path, const TensorMap& tensors);

}  // namespace ps
