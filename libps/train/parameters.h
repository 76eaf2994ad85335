// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ps::train {

using torch::Tensor;
using TensorsByName = std::map<std::string, Tensor>;

/// @brief The tensors of one network, under the names that libps/models reads them by, without the
/// network's prefix. Convolutions' weights are stored channels last, which is what oneDNN is fast
/// at.
class Parameters {
 public:
  /// @param prefix  of the names in a weights file: "pts_regressor."
  /// @param seed    of the first values
  Parameters(std::string prefix, std::uint64_t seed);

  /// @brief Trained, drawn from N(0, deviation^2).
  void normal(const std::string& name, torch::IntArrayRef shape, double deviation);
  /// @brief Trained, all of one value.
  void constant(const std::string& name, torch::IntArrayRef shape, double value);
  /// @brief Kept and saved, not trained.
  void state(const std::string& name, Tensor value);

  /// Throws ps::Error when there is none of this name.
  const Tensor& operator[](const std::string& name) const;

  const std::string& prefix() const { return prefix_; }
  const TensorsByName& trained() const { return trained_; }
  const TensorsByName& states() const { return states_; }
  std::vector<Tensor> all() const;  ///< trained and states, each by name
  std::int64_t count() const;       ///< of trained values

  void to(torch::Device device);
  /// @brief All tensors with the network's prefix; they share memory with this.
  TensorsByName named() const;
  /// @brief Copies values of named(); throws ps::Error when one is missing or of another shape.
  void load(const TensorsByName& values, const std::string& where);

 private:
  std::string prefix_;
  torch::Generator generator_;
  TensorsByName trained_, states_;
};

/// @brief Adam (Kingma and Ba, ICLR 2015) over one network, and the exponential average of its
/// weights (Polyak and Juditsky, 1992), which is what is evaluated and shipped.
class Adam {
 public:
  struct Options {
    double beta1 = 0.9, beta2 = 0.99, eps = 1e-8;
    double weight_decay = 0;       ///< decoupled, of tensors of two axes and more
    double average_decay = 0.999;  ///< of the average of weights; reached slowly at first
    double gradient_limit = 1;     ///< of the norm of all gradients; 0 = none
  };
  Adam(Parameters& parameters, const Options& options);

  void zero_gradients();
  /// @brief One step along the gradients; a step whose gradients are not finite is left out.
  /// @return whether it was taken
  bool step(double learning_rate);

  /// @brief Begins the average anew with the weights as they are.
  void restart_average();
  /// @brief Exchanges the weights with their average; called twice it does nothing.
  void swap_average();

  TensorsByName named() const;  ///< its state, for a checkpoint; shares memory
  void load(const TensorsByName& values, const std::string& where);

 private:
  /// What gradients are multiplied by to keep to the limit; 0 where they are not finite.
  double gradient_factor() const;

  Parameters& parameters_;
  Options options_;
  TensorsByName first_, second_, average_;
  Tensor steps_;
};

/// @brief A random stream for one step of one training: the same whatever came before.
torch::Generator generator_of(std::uint64_t seed, std::int64_t step,
                              torch::Device device = torch::kCPU);

}  // namespace ps::train
