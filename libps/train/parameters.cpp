// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/parameters.h"

#include <ATen/CPUGeneratorImpl.h>

#include <cmath>

#include "libps/core/error.h"
#include "libps/core/random.h"
#include "libps/train/adam_loops.h"

namespace ps::train {
namespace {

Tensor stored(const Tensor& value) {
  return value.dim() == 4 ? value.contiguous(torch::MemoryFormat::ChannelsLast) : value;
}

std::string shape_text(const Tensor& tensor) {
  std::string text = "[";
  for (const auto side : tensor.sizes()) {
    text += (text.size() > 1 ? ", " : "") + std::to_string(side);
  }
  return text + "]";
}

void copy_named(const Tensor& to, const TensorsByName& from, const std::string& name,
                const std::string& where) {
  const auto found = from.find(name);
  if (found == from.end()) {
    throw Error(where, "there is no tensor " + name, "tensors of the network that is trained");
  }
  if (found->second.sizes() != to.sizes()) {
    throw Error(where, name + " has shape " + shape_text(found->second), shape_text(to));
  }
  const torch::NoGradGuard guard;
  to.detach().copy_(found->second);
}

}  // namespace

Parameters::Parameters(std::string prefix, std::uint64_t seed)
    : prefix_(std::move(prefix)), generator_(generator_of(seed, -1)) {}

void Parameters::normal(const std::string& name, torch::IntArrayRef shape, double deviation) {
  const Tensor value = stored(torch::randn(shape, generator_) * deviation);
  trained_[name] = value.detach().requires_grad_(true);
}

void Parameters::constant(const std::string& name, torch::IntArrayRef shape, double value) {
  trained_[name] = torch::full(shape, value).requires_grad_(true);
}

void Parameters::state(const std::string& name, Tensor value) { states_[name] = value.detach(); }

const Tensor& Parameters::operator[](const std::string& name) const {
  auto found = trained_.find(name);
  if (found != trained_.end()) return found->second;
  found = states_.find(name);
  if (found == states_.end()) throw Error(prefix_ + name, "the network has no such tensor");
  return found->second;
}

std::vector<Tensor> Parameters::all() const {
  std::vector<Tensor> tensors;
  for (const auto& [name, tensor] : trained_) tensors.push_back(tensor);
  for (const auto& [name, tensor] : states_) tensors.push_back(tensor);
  return tensors;
}

std::int64_t Parameters::count() const {
  std::int64_t sum = 0;
  for (const auto& [name, tensor] : trained_) sum += tensor.numel();
  return sum;
}

void Parameters::to(torch::Device device) {
  for (auto& [name, tensor] : trained_) tensor = tensor.detach().to(device).requires_grad_(true);
  for (auto& [name, tensor] : states_) tensor = tensor.to(device);
}

TensorsByName Parameters::named() const {
  TensorsByName tensors;
  for (const auto& [name, tensor] : trained_) tensors[prefix_ + name] = tensor.detach();
  for (const auto& [name, tensor] : states_) tensors[prefix_ + name] = tensor;
  return tensors;
}

void Parameters::load(const TensorsByName& values, const std::string& where) {
  for (const auto& [name, tensor] : named()) copy_named(tensor, values, name, where);
}

Adam::Adam(Parameters& parameters, const Options& options)
    : parameters_(parameters), options_(options), steps_(torch::zeros({1}, torch::kFloat64)) {
  for (const auto& [name, tensor] : parameters.trained()) {
    first_[name] = torch::zeros_like(tensor).detach();
    second_[name] = torch::zeros_like(tensor).detach();
    average_[name] = tensor.detach().clone();
  }
  for (const auto& [name, tensor] : parameters.states()) {
    if (tensor.is_floating_point()) average_[name] = tensor.clone();
  }
}

void Adam::zero_gradients() {
  for (const auto& [name, tensor] : parameters_.trained()) tensor.mutable_grad() = Tensor();
}

double Adam::gradient_factor() const {
  double sum = 0;
  for (const auto& [name, tensor] : parameters_.trained()) {
    if (tensor.grad().defined()) sum += sum_of_squares(tensor.grad());
  }
  const double norm = std::sqrt(sum);
  const bool over = options_.gradient_limit > 0 && norm > options_.gradient_limit;
  return over ? options_.gradient_limit / norm : std::isfinite(norm) ? 1 : 0;
}

bool Adam::step(double learning_rate) {
  const torch::NoGradGuard guard;
  const double factor = gradient_factor();
  if (factor == 0) return false;
  steps_ += 1;
  const double t = steps_.item<double>();
  const double one = 1 - std::pow(options_.beta1, t), two = 1 - std::pow(options_.beta2, t);
  const double decay = std::min(options_.average_decay, (1 + t) / (10 + t));
  AdamRates rates;
  rates.gradient = static_cast<float>(factor);
  rates.beta1 = static_cast<float>(options_.beta1);
  rates.beta2 = static_cast<float>(options_.beta2);
  rates.rate = static_cast<float>(learning_rate / one);
  rates.correction = static_cast<float>(1 / two);
  rates.eps = static_cast<float>(options_.eps);
  rates.to_average = static_cast<float>(1 - decay);
  for (auto& [name, average] : average_) {
    const Tensor value = parameters_[name].detach(), gradient = parameters_[name].grad();
    if (!gradient.defined()) {
      average.lerp_(value, 1 - decay);
      continue;
    }
    const bool decays = options_.weight_decay > 0 && value.dim() > 1;
    rates.shrink = decays ? static_cast<float>(1 - learning_rate * options_.weight_decay) : 1;
    move_along(gradient, value, first_[name], second_[name], average, rates);
  }
  return true;
}

void Adam::restart_average() {
  const torch::NoGradGuard guard;
  for (auto& [name, average] : average_) average.copy_(parameters_[name].detach());
}

void Adam::swap_average() {
  const torch::NoGradGuard guard;
  for (auto& [name, average] : average_) {
    const Tensor now = parameters_[name].detach();
    const Tensor kept = now.clone();
    now.copy_(average);
    average.copy_(kept);
  }
}

TensorsByName Adam::named() const {
  TensorsByName tensors = {{"adam." + parameters_.prefix() + "steps", steps_}};
  const auto add = [&](const std::string& kind, const TensorsByName& from) {
    for (const auto& [name, t] : from) tensors[kind + parameters_.prefix() + name] = t;
  };
  add("first.", first_);
  add("second.", second_);
  add("average.", average_);
  return tensors;
}

void Adam::load(const TensorsByName& values, const std::string& where) {
  for (const auto& [name, tensor] : named()) copy_named(tensor, values, name, where);
}

torch::Generator generator_of(std::uint64_t seed, std::int64_t step, torch::Device device) {
  const auto bits = random_bits(seed, {static_cast<std::uint32_t>(step),
                                       static_cast<std::uint32_t>(step >> 32), 0x747261u, 0});
  torch::Generator generator = at::globalContext().defaultGenerator(device).clone();
  generator.set_current_seed((static_cast<std::uint64_t>(bits[0]) << 32) | bits[1]);
  return generator;
}

}  // namespace ps::train
