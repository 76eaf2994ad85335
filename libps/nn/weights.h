// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace ps::nn {

/// A tensor of weights, row-major, in torch's order of axes.
struct WeightTensor {
  std::vector<std::size_t> shape;
  std::vector<float> values;
  /// What the file held them as. A tensor of any type but F32, F16, BF16 and F64 (a counter) has no
  /// values, and lookups refuse it.
  std::string type = "F32";

  std::size_t elements() const;  ///< as the shape says
};

/// @return whether this, as safetensors spells it, is F32, F16, BF16 or F64
bool is_float_type(const std::string& type);

/// @return "[16, 3, 4, 4]"
std::string to_string(const std::vector<std::size_t>& shape);

/// @brief Named weights of one or more networks, as the published state dict names them, without
/// wrapper prefixes (DESIGN.md). All lookups throw ps::Error that names the tensor when it is
/// missing, no floats, of another shape than asked for, or holds a value that is not finite.
class Weights {
 public:
  /// In an asked-for shape: this axis may be anything but 0.
  static constexpr std::size_t kAny = 0;

  Weights() = default;
  /// Throws ps::Error when a tensor's values do not fill its shape.
  /// @param name  stands in messages: the file they came from
  Weights(std::string name, std::map<std::string, WeightTensor> tensors);

  bool has(const std::string& name) const;
  /// @return whether any name begins with this
  bool has_prefix(const std::string& prefix) const;

  const WeightTensor& get(const std::string& name, const std::vector<std::size_t>& shape) const;

  /// @brief A layer's weight as the network uses it: `PREFIX.weight` itself, or `weight_orig` over
  /// its spectral norm u^T M v (M is it reshaped to [out, rest]; SPEC.md 3), or `weight_g` * v /
  /// |v| of `weight_v` by rows (weight norm).
  WeightTensor layer(const std::string& prefix, const std::vector<std::size_t>& shape) const;

  /// @brief A vector of `count` values; zeros when it is absent and `optional`.
  std::vector<float> vector(const std::string& name, std::size_t count,
                            bool optional = false) const;

  /// @brief The same; throws also when a value is negative.
  std::vector<float> variance(const std::string& name, std::size_t count) const;

  const std::map<std::string, WeightTensor>& tensors() const { return tensors_; }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::map<std::string, WeightTensor> tensors_;
};

/// @brief What a BatchNorm does in evaluation, as y = x * scale + shift for each channel.
struct ScaleShift {
  std::vector<float> scale, shift;
};

/// @brief `PREFIX.weight`, `.bias`, `.running_mean`, `.running_var`; eps 1e-5.
ScaleShift batch_norm(const Weights& weights, const std::string& prefix, std::size_t channels);

}  // namespace ps::nn
