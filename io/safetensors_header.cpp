// SPDX-License-Identifier: BSD-3-Clause
#include "io/safetensors_header.h"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "io/bytes.h"
#include "io/json.h"
#include "io/text.h"

namespace ps {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestHeader = 100'000'000;  // as the reference implementation

std::vector<std::size_t> sizes_of(const Json& tensor, const char* key, const std::string& where) {
  std::vector<std::size_t> sizes;
  if (!tensor.contains(key) || !tensor[key].is_array()) {
    throw Error(where, std::string("has no ") + key, "a list of whole numbers");
  }
  for (const Json& size : tensor[key]) {
    if (!size.is_number_unsigned()) {
      throw Error(where, std::string(key) + " holds " + in_quotes(size.dump()), "whole numbers");
    }
    sizes.push_back(size.get<std::size_t>());
  }
  return sizes;
}

/// @param data  where the data begin   @param size  of the file
SafetensorsEntry parse_entry(const std::string& key, const Json& json, std::size_t data,
                             std::size_t size, const std::string& file) {
  const std::string where = file + ", tensor " + in_quotes(key, kLongestShown);
  if (!json.is_object() || !json.contains("dtype") || !json["dtype"].is_string()) {
    throw Error(where, "has no dtype", "dtype, shape and data_offsets");
  }
  const std::size_t room = size - data;
  SafetensorsEntry entry;
  entry.name = key;
  entry.dtype = json["dtype"].get<std::string>();
  entry.shape = sizes_of(json, "shape", where);
  const std::vector<std::size_t> offsets = sizes_of(json, "data_offsets", where);
  const std::optional<std::size_t> element = element_bytes(entry.dtype);
  if (!element) throw Error(where, "dtype " + in_quotes(entry.dtype), "F32, F16, I64, ...");
  if (offsets.size() != 2 || offsets[0] > offsets[1] || offsets[1] > room) {
    throw Error(where, "its data lie outside the file",
                "data_offsets within " + std::to_string(room));
  }
  entry.begin = data + offsets[0];
  entry.end = data + offsets[1];
  if (product(entry.shape, *element) != entry.end - entry.begin) {
    throw Error(where, std::to_string(entry.end - entry.begin) + " bytes do not fit its shape",
                "dtype, shape and data_offsets that agree");
  }
  return entry;
}

}  // namespace

std::optional<std::size_t> element_bytes(const std::string& dtype) {
  static const std::map<std::string, std::size_t> kSizes{
      {"BOOL", 1}, {"U8", 1},  {"I8", 1},  {"F8_E4M3", 1}, {"F8_E5M2", 1},
      {"U16", 2},  {"I16", 2}, {"F16", 2}, {"BF16", 2},    {"U32", 4},
      {"I32", 4},  {"F32", 4}, {"U64", 8}, {"I64", 8},     {"F64", 8},
  };
  const auto found = kSizes.find(dtype);
  return found == kSizes.end() ? std::nullopt : std::optional<std::size_t>(found->second);
}

std::optional<std::size_t> product(const std::vector<std::size_t>& shape, std::size_t start) {
  std::size_t total = start;
  for (const std::size_t side : shape) {
    if (side != 0 && total > std::numeric_limits<std::size_t>::max() / side) return std::nullopt;
    total *= side;
  }
  return total;
}

SafetensorsHeader read_safetensors_header(std::size_t size, const ReadAt& read,
                                          const std::string& name) {
  if (size < 8) throw Error(name, std::to_string(size) + " bytes", "a safetensors file");
  std::uint64_t header_size = 0;
  read(0, &header_size, 8);
  if (header_size > size - 8 || header_size > kLongestHeader) {
    throw Error(name, "is no safetensors file, or truncated", "a header of the size it says");
  }
  std::string header(header_size, '\0');
  read(8, header.data(), header.size());
  Json json = parse_json_text(header, name);
  if (!json.is_object()) throw Error(name, "the header is no JSON object", "tensors by name");
  return {std::move(json), 8 + header_size};
}

std::vector<SafetensorsEntry> safetensors_entries(const SafetensorsHeader& header, std::size_t size,
                                                  const std::string& name) {
  std::vector<SafetensorsEntry> entries;
  for (const auto& [key, value] : header.json.items()) {
    if (key == kSafetensorsMetadata) continue;
    entries.push_back(parse_entry(key, value, header.size, size, name));
  }
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return std::tie(a.begin, a.end) < std::tie(b.begin, b.end);
  });
  std::size_t end = 0;
  for (const SafetensorsEntry& entry : entries) {
    if (entry.begin < end) {
      throw Error(name, "tensor " + in_quotes(entry.name, kLongestShown) + " overlaps another",
                  "data side by side");
    }
    end = entry.end;
  }
  return entries;
}

}  // namespace ps
