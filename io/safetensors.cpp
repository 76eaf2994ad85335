// SPDX-License-Identifier: BSD-3-Clause
#include "io/safetensors.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/json.h"
#include "io/text.h"

namespace ps {
namespace {

using Json = nlohmann::json;
using ReadAt = std::function<void(std::size_t offset, void* to, std::size_t bytes)>;

constexpr const char* kMetadata = "__metadata__";
constexpr std::size_t kLongestShown = 512;           // of a tensor's name
constexpr std::size_t kLongestHeader = 100'000'000;  // as the reference implementation

/// @return bytes of one element; empty for a kind that safetensors does not have
std::optional<std::size_t> element_bytes(const std::string& dtype) {
  static const std::map<std::string, std::size_t> kSizes{
      {"BOOL", 1}, {"U8", 1},  {"I8", 1},  {"F8_E4M3", 1}, {"F8_E5M2", 1},
      {"U16", 2},  {"I16", 2}, {"F16", 2}, {"BF16", 2},    {"U32", 4},
      {"I32", 4},  {"F32", 4}, {"U64", 8}, {"I64", 8},     {"F64", 8},
  };
  const auto found = kSizes.find(dtype);
  return found == kSizes.end() ? std::nullopt : std::optional<std::size_t>(found->second);
}

/// @return the product, empty when it overflows
std::optional<std::size_t> product(const std::vector<std::size_t>& shape, std::size_t start) {
  std::size_t total = start;
  for (const std::size_t side : shape) {
    if (side != 0 && total > std::numeric_limits<std::size_t>::max() / side) return std::nullopt;
    total *= side;
  }
  return total;
}

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

struct Entry {
  std::string name;
  FileTensor tensor;  ///< without its bytes
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// @param room  bytes of data after the header
Entry parse_entry(const std::string& key, const Json& json, std::size_t room,
                  const std::string& file) {
  const std::string where = file + ", tensor " + in_quotes(key, kLongestShown);
  if (!json.is_object() || !json.contains("dtype") || !json["dtype"].is_string()) {
    throw Error(where, "has no dtype", "dtype, shape and data_offsets");
  }
  Entry entry;
  entry.name = key;
  entry.tensor.dtype = json["dtype"].get<std::string>();
  entry.tensor.shape = sizes_of(json, "shape", where);
  const std::vector<std::size_t> offsets = sizes_of(json, "data_offsets", where);
  const std::optional<std::size_t> element = element_bytes(entry.tensor.dtype);
  if (!element) throw Error(where, "dtype " + in_quotes(entry.tensor.dtype), "F32, F16, I64, ...");
  if (offsets.size() != 2 || offsets[0] > offsets[1] || offsets[1] > room) {
    throw Error(where, "its data lie outside the file",
                "data_offsets within " + std::to_string(room));
  }
  entry.begin = offsets[0];
  entry.end = offsets[1];
  if (product(entry.tensor.shape, *element) != entry.end - entry.begin) {
    throw Error(where, std::to_string(entry.end - entry.begin) + " bytes do not fit its shape",
                "dtype, shape and data_offsets that agree");
  }
  return entry;
}

struct Header {
  Json json;             ///< an object
  std::size_t size = 0;  ///< bytes before the data
};

Header read_header(std::size_t size, const ReadAt& read, const std::string& name) {
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

TensorMap parse(std::size_t size, const ReadAt& read, const std::string& name) {
  const Header header = read_header(size, read, name);
  std::vector<Entry> entries;
  for (const auto& [key, value] : header.json.items()) {
    if (key == kMetadata) continue;
    entries.push_back(parse_entry(key, value, size - header.size, name));
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.begin, a.end) < std::tie(b.begin, b.end);
  });
  std::size_t end = 0;
  for (const Entry& entry : entries) {
    if (entry.begin < end) {
      throw Error(name, "tensor " + in_quotes(entry.name, kLongestShown) + " overlaps another",
                  "data side by side");
    }
    end = entry.end;
  }
  TensorMap tensors;
  for (Entry& entry : entries) {
    entry.tensor.bytes.resize(entry.end - entry.begin);
    read(header.size + entry.begin, entry.tensor.bytes.data(), entry.tensor.bytes.size());
    tensors.emplace(std::move(entry.name), std::move(entry.tensor));
  }
  return tensors;
}

ReadAt reader_of(const InputFile& file) {
  return [&file](std::size_t offset, void* to, std::size_t bytes) { file.read(offset, to, bytes); };
}

template <class T>
std::vector<float> converted(const FileTensor& tensor) {
  std::vector<float> values(tensor.bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    T value;
    std::memcpy(&value, &tensor.bytes[i * sizeof(T)], sizeof(T));
    values[i] = static_cast<float>(value);
  }
  return values;
}

template <class T>
FileTensor made(const char* dtype, const std::vector<T>& values, std::vector<std::size_t> shape) {
  if (product(shape, 1) != values.size()) {
    throw Error("tensor", std::to_string(values.size()) + " values do not fill its shape",
                "a shape whose product is that");
  }
  FileTensor tensor{dtype, std::move(shape), {}};
  tensor.bytes.resize(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(tensor.bytes.data(), values.data(), tensor.bytes.size());
  return tensor;
}

/// Tensors in the order of their data: wide elements first, so that each is aligned to its own.
std::vector<const TensorMap::value_type*> in_data_order(const TensorMap& tensors,
                                                        const std::string& where) {
  std::vector<const TensorMap::value_type*> order;
  const auto width = [](const TensorMap::value_type* item) {
    return element_bytes(item->second.dtype).value_or(0);
  };
  for (const auto& item : tensors) {
    if (item.first == kMetadata || width(&item) == 0 ||
        product(item.second.shape, width(&item)) != item.second.bytes.size()) {
      throw Error(where, "tensor " + in_quotes(item.first, kLongestShown) + " is unsound",
                  "a known dtype, and bytes that fit the shape");
    }
    order.push_back(&item);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](const auto* a, const auto* b) { return width(a) > width(b); });
  return order;
}

}  // namespace

std::size_t FileTensor::elements() const { return product(shape, 1).value_or(0); }

std::vector<float> FileTensor::as_floats() const {
  if (product(shape, element_bytes(dtype).value_or(1)) != bytes.size()) {
    throw Error("tensor", "its bytes do not fit its shape", "bytes that do");
  }
  if (dtype == "F32") return converted<float>(*this);
  if (dtype == "F16") return converted<Eigen::half>(*this);
  if (dtype == "BF16") return converted<Eigen::bfloat16>(*this);
  if (dtype == "F64") return converted<double>(*this);
  if (dtype == "I32") return converted<std::int32_t>(*this);
  if (dtype == "I64") return converted<std::int64_t>(*this);
  if (dtype == "U8" || dtype == "BOOL") return converted<std::uint8_t>(*this);
  throw Error("tensor", "dtype " + in_quotes(dtype) + " cannot become float",
              "F32, F16, BF16, F64, I32, I64, U8 or BOOL");
}

FileTensor FileTensor::of(const std::vector<float>& values, std::vector<std::size_t> shape) {
  return made("F32", values, std::move(shape));
}

FileTensor FileTensor::of(const std::vector<std::int32_t>& values, std::vector<std::size_t> shape) {
  return made("I32", values, std::move(shape));
}

FileTensor FileTensor::of(const std::vector<std::uint8_t>& values, std::vector<std::size_t> shape) {
  return made("U8", values, std::move(shape));
}

TensorMap parse_safetensors(std::string_view bytes, const std::string& name) {
  return guarded(name, [&] {
    const auto read = [&](std::size_t offset, void* to, std::size_t count) {
      if (count > 0) std::memcpy(to, bytes.data() + offset, count);
    };
    return parse(bytes.size(), read, name);
  });
}

TensorMap read_safetensors(const std::filesystem::path& path) {
  return guarded(path.string(), [&] {
    const InputFile file(path);
    return parse(file.size(), reader_of(file), path.string());
  });
}

Metadata read_safetensors_metadata(const std::filesystem::path& path) {
  const std::string name = path.string();
  return guarded(name, [&] {
    const InputFile file(path);
    const Header header = read_header(file.size(), reader_of(file), name);
    Metadata metadata;
    const Json words = header.json.value(kMetadata, Json::object());
    for (const auto& [key, value] : words.items()) {
      if (!words.is_object() || !value.is_string()) {
        throw Error(name, "its metadata " + in_quotes(key) + " is no text", "text by name");
      }
      metadata[key] = value.get<std::string>();
    }
    return metadata;
  });
}

void write_safetensors(const std::filesystem::path& path, const TensorMap& tensors,
                       const Metadata& metadata) {
  guarded(path.string(), [&] {
    const auto order = in_data_order(tensors, path.string());
    Json json = Json::object();
    if (!metadata.empty()) json[kMetadata] = metadata;
    std::size_t offset = 0;
    for (const auto* item : order) {
      const FileTensor& tensor = item->second;
      json[item->first] = {{"dtype", tensor.dtype},
                           {"shape", tensor.shape},
                           {"data_offsets", {offset, offset + tensor.bytes.size()}}};
      offset += tensor.bytes.size();
    }
    std::string header = json.dump();
    header.resize((header.size() + 7) / 8 * 8, ' ');
    const std::uint64_t header_size = header.size();
    AtomicFile file(path);
    file.write(&header_size, sizeof header_size);
    file.write(header);
    for (const auto* item : order) file.write(item->second.bytes.data(), item->second.bytes.size());
    file.commit();
  });
}

}  // namespace ps
