// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
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

/// Words that a file may hold beside its tensors, by name (`__metadata__`).
using Metadata = std::map<std::string, std::string>;

/// @brief Reads a safetensors file (huggingface/safetensors, "Format"). Throws ps::Error when the
/// header is unsound, offsets overlap or overrun, sizes disagree with shapes, or the file is too
/// short.
TensorMap read_safetensors(const std::filesystem::path& path);

/// @brief The same from a file's bytes; `name` stands in messages.
TensorMap parse_safetensors(std::string_view bytes, const std::string& name);

/// @brief Reads the header's `__metadata__` alone; empty when there is none. Throws ps::Error when
/// the header is unsound, or a value of it is no text.
Metadata read_safetensors_metadata(const std::filesystem::path& path);

/// @brief Writes all tensors without gaps, as the reference implementation does: wide elements
/// first, then by name, from a multiple of 8 bytes on, so that each tensor is aligned to its
/// elements. The file appears whole or not at all. Throws ps::Error when a tensor's bytes do not
/// fit its shape.
void write_safetensors(const std::filesystem::path& path, const TensorMap& tensors,
                       const Metadata& metadata = {});

}  // namespace ps
