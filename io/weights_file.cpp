// SPDX-License-Identifier: BSD-3-Clause
#include "io/weights_file.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

#include "io/bytes.h"
#include "io/text.h"
#include "io/torch_checkpoint.h"

namespace ps {
namespace {

constexpr std::string_view kNetworks[] = {"pts_regressor", "vqvae", "outpaint2",
                                          "projector",     "netD",  "classifier"};
constexpr std::string_view kRepeated = "netD";
constexpr std::size_t kLongestShown = 512;

std::string tensor_in(const std::string& file, const std::string& name) {
  return file + ", tensor " + in_quotes(name, kLongestShown);
}

/// The part of `name` from `begin` to the next dot; without that, empty: a network's name ends with
/// one.
std::string_view component(std::string_view name, std::size_t begin) {
  const std::size_t dot = name.find('.', begin);
  return dot == std::string_view::npos ? "" : name.substr(begin, dot - begin);
}

bool is_network(std::string_view word) {
  return std::find(std::begin(kNetworks), std::end(kNetworks), word) != std::end(kNetworks);
}

TensorMap under_project_names(TensorMap tensors, const std::string& file) {
  TensorMap renamed;
  while (!tensors.empty()) {
    auto node = tensors.extract(tensors.begin());
    const std::string old = node.key();
    node.key() = project_name(old);
    const auto printable = [](unsigned char c) { return c >= ' ' && c != 0x7f; };
    if (node.key().empty() || !std::all_of(old.begin(), old.end(), printable)) {
      throw Error(tensor_in(file, old), "its name is empty or not printable", "a name");
    }
    const auto added = renamed.insert(std::move(node));
    if (!added.inserted) {
      throw Error(tensor_in(file, old),
                  "another one is also called " + in_quotes(added.position->first, kLongestShown) +
                      " without its prefix",
                  "names that stay apart");
    }
  }
  return renamed;
}

nn::Weights to_weights(TensorMap tensors, const std::string& file) {
  std::map<std::string, nn::WeightTensor> weights;
  while (!tensors.empty()) {  // one by one, so that not all are held twice
    const auto node = tensors.extract(tensors.begin());
    const FileTensor& tensor = node.mapped();
    nn::WeightTensor weight{tensor.shape, {}, tensor.dtype};
    if (nn::is_float_type(tensor.dtype)) weight.values = tensor.as_floats();
    weights.emplace(node.key(), std::move(weight));
  }
  return {file, std::move(weights)};
}

/// @return the float as `Number` stores it; throws when only that makes it infinite
template <class Number>
Number rounded(float value, const std::string& file, const std::string& name,
               const char* type_name) {
  const auto number = static_cast<Number>(value);
  if (std::isfinite(value) && !std::isfinite(static_cast<float>(number))) {
    throw Error(tensor_in(file, name),
                "its value " + std::to_string(value) + " is too large for " + type_name,
                "another type");
  }
  return number;
}

template <class Number>
std::vector<std::byte> packed(const std::vector<float>& values, const std::string& file,
                              const std::string& name, const char* type_name) {
  std::vector<std::byte> bytes(values.size() * sizeof(Number));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Number number = rounded<Number>(values[i], file, name, type_name);
    std::memcpy(&bytes[i * sizeof(Number)], &number, sizeof(Number));
  }
  return bytes;
}

FileTensor stored(const std::vector<float>& values, std::vector<std::size_t> shape, FloatType type,
                  const std::string& file, const std::string& name) {
  switch (type) {
    case FloatType::f16:
      return {"F16", std::move(shape), packed<Eigen::half>(values, file, name, "f16")};
    case FloatType::bf16:
      return {"BF16", std::move(shape), packed<Eigen::bfloat16>(values, file, name, "bf16")};
    case FloatType::f32:
      break;
  }
  return FileTensor::of(values, std::move(shape));
}

bool holds_checkpoint(const std::filesystem::path& path) {
  const InputFile file(path);
  std::string head(std::min(file.size(), kCheckpointHead), '\0');
  file.read(0, head.data(), head.size());
  return is_torch_checkpoint(head);
}

}  // namespace

bool names_network(const std::string& name) { return is_network(component(name, 0)); }

std::string project_name(const std::string& name) {
  std::string_view rest = name;
  for (std::string_view word = component(rest, 0); !word.empty(); word = component(rest, 0)) {
    if (is_network(word)) break;
    rest.remove_prefix(word.size() + 1);
  }
  if (is_network(component(rest, 0))) {
    while (component(rest, 0) == kRepeated && component(rest, kRepeated.size() + 1) == kRepeated) {
      rest.remove_prefix(kRepeated.size() + 1);
    }
    return std::string(rest);
  }
  rest = name;
  for (const std::string_view wrapper : {"model", "module"}) {
    if (component(rest, 0) == wrapper) rest.remove_prefix(wrapper.size() + 1);
  }
  return std::string(rest);
}

TensorMap read_weight_tensors(const std::filesystem::path& path) {
  const std::string name = path.string();
  return guarded(name, [&] {
    return under_project_names(
        holds_checkpoint(path) ? read_torch_checkpoint(path) : read_safetensors(path), name);
  });
}

Metadata read_metadata(const std::filesystem::path& path) {
  return guarded(path.string(), [&] {
    return holds_checkpoint(path) ? Metadata() : read_safetensors_metadata(path);
  });
}

nn::Weights read_weights(const std::filesystem::path& path) {
  return guarded(path.string(),
                 [&] { return to_weights(read_weight_tensors(path), path.string()); });
}

nn::Weights parse_weights(std::string_view bytes, const std::string& name) {
  return guarded(name, [&] {
    TensorMap tensors = is_torch_checkpoint(bytes.substr(0, kCheckpointHead))
                            ? parse_torch_checkpoint(bytes, name)
                            : parse_safetensors(bytes, name);
    return to_weights(under_project_names(std::move(tensors), name), name);
  });
}

/// What f64 can hold and f32 cannot would become infinity.
static void check_fits_float(const FileTensor& tensor, const std::string& where,
                             const std::string& name) {
  if (tensor.dtype != "F64") return;
  for (std::size_t i = 0; i < tensor.elements(); ++i) {
    double value;
    std::memcpy(&value, tensor.bytes.data() + i * sizeof value, sizeof value);
    if (std::isfinite(value) && !std::isfinite(static_cast<float>(value))) {
      throw Error(where, "tensor '" + name + "' holds " + std::to_string(value),
                  "values that f32 can hold");
    }
  }
}

TensorMap stored_as(TensorMap tensors, FloatType type, const std::string& where) {
  for (auto& [name, tensor] : tensors) {
    if (!nn::is_float_type(tensor.dtype)) continue;
    check_fits_float(tensor, where, name);
    tensor = stored(tensor.as_floats(), tensor.shape, type, where, name);
  }
  return tensors;
}

void write_weights(const std::filesystem::path& path, const nn::Weights& weights, FloatType type,
                   const Metadata& metadata) {
  guarded(path.string(), [&] {
    TensorMap tensors;
    for (const auto& [name, tensor] : weights.tensors()) {
      if (!nn::is_float_type(tensor.type)) continue;
      tensors[name] = stored(tensor.values, tensor.shape, type, path.string(), name);
    }
    write_safetensors(path, tensors, metadata);
  });
}

}  // namespace ps
