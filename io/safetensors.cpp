// SPDX-License-Identifier: BSD-3-Clause
#include "io/safetensors.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/safetensors_header.h"
#include "io/text.h"

namespace ps {
namespace {

using Json = nlohmann::json;

TensorMap parse(std::size_t size, const ReadAt& read, const std::string& name) {
  const SafetensorsHeader header = read_safetensors_header(size, read, name);
  TensorMap tensors;
  for (SafetensorsEntry& entry : safetensors_entries(header, size, name)) {
    FileTensor tensor{std::move(entry.dtype), std::move(entry.shape), {}};
    tensor.bytes.resize(entry.end - entry.begin);
    read(entry.begin, tensor.bytes.data(), tensor.bytes.size());
    tensors.emplace(std::move(entry.name), std::move(tensor));
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
    if (item.first == kSafetensorsMetadata || width(&item) == 0 ||
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
    const SafetensorsHeader header = read_safetensors_header(file.size(), reader_of(file), name);
    Metadata metadata;
    const Json words = header.json.value(kSafetensorsMetadata, Json::object());
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
    if (!metadata.empty()) json[kSafetensorsMetadata] = metadata;
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
