// SPDX-License-Identifier: BSD-3-Clause
// Internal to `probe`: what its modules share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/context.h"
#include "io/safetensors.h"
#include "libps/outpaint/order.h"

namespace ps::apps {

struct ProbeFiles {
  std::string in;
  std::string out;
  std::string prefix;  ///< what the names in `in` begin with
};

/// @brief Adds --in, --out and --prefix.
void add_files(CLI::App& verb, ProbeFiles& files);

/// The tensors of --in.
class ProbeInput {
 public:
  /// Throws ps::Error as read_safetensors() does.
  explicit ProbeInput(const ProbeFiles& files);

  bool has(const std::string& name) const;

  /// @param name  without the prefix
  /// Throws ps::Error that says which tensors there are when there is no such one.
  const FileTensor& take(const std::string& name) const;

  /// @brief The same, of a given shape; a side of 0 may be anything from 1 to 2^24. Throws also
  /// when a value is not finite.
  const FileTensor& take(const std::string& name, const std::vector<std::size_t>& shape) const;

  /// @brief Codes of any type of number. Throws as take() does, and when one is no whole number of
  /// at most 2^24; below 0 is no code.
  std::vector<std::int32_t> codes(const std::string& name,
                                  const std::vector<std::size_t>& shape) const;

 private:
  [[noreturn]] void refuse(const std::string& name, std::size_t at, float value,
                           const std::string& expected) const;

  const ProbeFiles& files_;
  TensorMap tensors_;
};

/// @return 1 where the tensor is not 0
std::vector<std::uint8_t> mask_of(const FileTensor& tensor);
/// @brief Throws ps::Error, naming the weights, when a network made a value that is not finite.
void check_finite(const TensorMap& made, const std::string& weights);
/// @brief The order for the tensor `bg256`, [1,H,W]. Throws ps::Error when its sides are no
/// multiples of 8.
outpaint::Order order_of(const ProbeInput& in);

// Each adds modules to the verb.
void add_probe_splat(CLI::App& probe, const Context& context);
void add_probe_networks(CLI::App& probe, const Context& context);
void add_probe_outpaint(CLI::App& probe, const Context& context);

}  // namespace ps::apps
