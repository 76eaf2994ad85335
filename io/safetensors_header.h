// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: what a safetensors file says before its data.
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace ps {

constexpr const char* kSafetensorsMetadata = "__metadata__";
constexpr std::size_t kLongestShown = 512;  ///< of a tensor's name, in messages

/// Reads bytes of a file; throws ps::Error when they are not there.
using ReadAt = std::function<void(std::size_t offset, void* to, std::size_t bytes)>;

struct SafetensorsHeader {
  nlohmann::json json;   ///< an object
  std::size_t size = 0;  ///< bytes before the data
};

/// @param size  of the file   @param name  stands in messages
SafetensorsHeader read_safetensors_header(std::size_t size, const ReadAt& read,
                                          const std::string& name);

/// A tensor's place in the file.
struct SafetensorsEntry {
  std::string name, dtype;
  std::vector<std::size_t> shape;
  std::size_t begin = 0, end = 0;  ///< bytes from the file's start
};

/// @return the tensors, by place. Throws ps::Error when one is unsound, lies outside of the file or
/// overlaps another.
std::vector<SafetensorsEntry> safetensors_entries(const SafetensorsHeader& header, std::size_t size,
                                                  const std::string& name);

/// @return bytes of one element; empty for a kind that safetensors does not have
std::optional<std::size_t> element_bytes(const std::string& dtype);

/// @return the product of `start` and all sides; empty when it overflows
std::optional<std::size_t> product(const std::vector<std::size_t>& shape, std::size_t start);

}  // namespace ps
