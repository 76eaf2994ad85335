// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libps/core/error.h"

namespace ps::nn {
namespace {

using Axes = std::vector<std::size_t>;

constexpr double kBatchNormEpsilon = 1e-5;

std::string called(const std::string& name) { return "tensor '" + name + "'"; }

/// A shape that may hold kAny.
std::string wanted(const Axes& shape) {
  std::string text;
  for (const std::size_t side : shape) {
    text += (text.empty() ? "" : ", ") + (side == Weights::kAny ? "any" : std::to_string(side));
  }
  return "the shape [" + text + "]";
}

bool fits(const Axes& found, const Axes& shape) {
  return std::equal(found.begin(), found.end(), shape.begin(), shape.end(),
                    [](std::size_t has, std::size_t asked) {
                      return has > 0 && (asked == Weights::kAny || has == asked);
                    });
}

/// @param what  "tensor 'conv1.weight'"
void check_finite(const std::string& file, const std::string& what,
                  const std::vector<float>& values) {
  const auto bad = std::find_if_not(values.begin(), values.end(),
                                    [](float value) { return std::isfinite(value); });
  if (bad == values.end()) return;
  throw Error(file,
              what + " holds " + (std::isnan(*bad) ? "NaN" : "infinity") + " (value " +
                  std::to_string(bad - values.begin()) + " of " + std::to_string(values.size()) +
                  ")",
              "finite numbers");
}

/// Rows of a weight as a matrix [out, rest], neither of them 0.
std::size_t rows_of(const WeightTensor& weight) {
  return weight.shape.empty() ? 1 : weight.shape[0];
}

WeightTensor spectrally_normed(const Weights& weights, const std::string& name, const Axes& shape) {
  WeightTensor weight = weights.get(name + "_orig", shape);
  const std::size_t rows = rows_of(weight), columns = weight.values.size() / rows;
  const std::vector<float> u = weights.vector(name + "_u", rows);
  const std::vector<float> v = weights.vector(name + "_v", columns);
  double norm = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    double row = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      row += static_cast<double>(weight.values[r * columns + c]) * v[c];
    }
    norm += u[r] * row;
  }
  if (norm == 0) {
    throw Error(weights.name(), "the spectral norm u^T M v of " + called(name + "_orig") + " is 0",
                "another number");
  }
  for (float& value : weight.values) value = static_cast<float>(value / norm);
  check_finite(weights.name(), called(name + "_orig") + " over its spectral norm", weight.values);
  return weight;
}

WeightTensor weight_normed(const Weights& weights, const std::string& name, const Axes& shape) {
  WeightTensor weight = weights.get(name + "_v", shape);
  const std::size_t rows = rows_of(weight), columns = weight.values.size() / rows;
  Axes one_a_row(weight.shape.size(), 1);
  if (!one_a_row.empty()) one_a_row[0] = rows;
  const WeightTensor& lengths = weights.get(name + "_g", one_a_row);
  for (std::size_t r = 0; r < rows; ++r) {
    float* const row = weight.values.data() + r * columns;
    double square = 0;
    for (std::size_t c = 0; c < columns; ++c) square += static_cast<double>(row[c]) * row[c];
    if (square == 0) {
      throw Error(weights.name(), "row " + std::to_string(r) + " of " + called(name + "_v") +
                                      " is 0 and has no direction");
    }
    const double scale = lengths.values[r] / std::sqrt(square);
    for (std::size_t c = 0; c < columns; ++c) row[c] = static_cast<float>(row[c] * scale);
  }
  check_finite(weights.name(), called(name + "_v") + ", weight-normed,", weight.values);
  return weight;
}

}  // namespace

std::size_t WeightTensor::elements() const {
  std::size_t product = 1;
  for (const std::size_t side : shape) {
    const bool too_many = side != 0 && product > std::numeric_limits<std::size_t>::max() / side;
    product = too_many ? std::numeric_limits<std::size_t>::max() : product * side;
  }
  return product;
}

bool is_float_type(const std::string& type) {
  return type == "F32" || type == "F16" || type == "BF16" || type == "F64";
}

std::string to_string(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t side : shape) text += (text.empty() ? "" : ", ") + std::to_string(side);
  return "[" + text + "]";
}

Weights::Weights(std::string name, std::map<std::string, WeightTensor> tensors)
    : name_(std::move(name)), tensors_(std::move(tensors)) {
  for (const auto& [key, tensor] : tensors_) {
    const std::size_t expected = is_float_type(tensor.type) ? tensor.elements() : 0;
    if (tensor.values.size() == expected) continue;
    throw Error(name_, called(key) + " has " + std::to_string(tensor.values.size()) + " values",
                std::to_string(expected) + " for the shape " + to_string(tensor.shape));
  }
}

bool Weights::has(const std::string& name) const { return tensors_.count(name) > 0; }

bool Weights::has_prefix(const std::string& prefix) const {
  const auto first = tensors_.lower_bound(prefix);
  return first != tensors_.end() && first->first.compare(0, prefix.size(), prefix) == 0;
}

const WeightTensor& Weights::get(const std::string& name,
                                 const std::vector<std::size_t>& shape) const {
  const auto found = tensors_.find(name);
  if (found == tensors_.end()) throw Error(name_, called(name) + " is missing", wanted(shape));
  const WeightTensor& tensor = found->second;
  if (!is_float_type(tensor.type)) {
    throw Error(name_, called(name) + " is of type " + tensor.type, "F32, F16, BF16 or F64");
  }
  if (!fits(tensor.shape, shape)) {
    throw Error(name_, called(name) + " has the shape " + to_string(tensor.shape), wanted(shape));
  }
  check_finite(name_, called(name), tensor.values);
  return tensor;
}

WeightTensor Weights::layer(const std::string& prefix,
                            const std::vector<std::size_t>& shape) const {
  const std::string name = prefix + ".weight";
  if (has(name)) return get(name, shape);
  if (has(name + "_orig")) return spectrally_normed(*this, name, shape);
  if (has(name + "_g") || has(name + "_v")) return weight_normed(*this, name, shape);
  throw Error(name_, called(name) + " is missing, and so are " + name + "_orig and " + name + "_g",
              wanted(shape));
}

std::vector<float> Weights::vector(const std::string& name, std::size_t count,
                                   bool optional) const {
  if (optional && !has(name)) return std::vector<float>(count);
  return get(name, {count}).values;
}

std::vector<float> Weights::variance(const std::string& name, std::size_t count) const {
  const std::vector<float> values = vector(name, count);
  for (const float value : values) {
    if (value < 0) {
      throw Error(name_, called(name) + " holds " + std::to_string(value), "no negative variance");
    }
  }
  return values;
}

ScaleShift batch_norm(const Weights& weights, const std::string& prefix, std::size_t channels) {
  const std::vector<float> weight = weights.vector(prefix + ".weight", channels);
  const std::vector<float> bias = weights.vector(prefix + ".bias", weight.size());
  const std::vector<float> mean = weights.vector(prefix + ".running_mean", weight.size());
  const std::vector<float> variance = weights.variance(prefix + ".running_var", weight.size());
  ScaleShift norm;
  for (std::size_t c = 0; c < weight.size(); ++c) {
    const double scale = weight[c] / std::sqrt(variance[c] + kBatchNormEpsilon);
    norm.scale.push_back(static_cast<float>(scale));
    norm.shift.push_back(static_cast<float>(bias[c] - mean[c] * scale));
  }
  return norm;
}

}  // namespace ps::nn
