// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/discriminator.h"

#include <string>

#include "libps/train/layers.h"

namespace ps::train {
namespace {

constexpr int kLayers = 5;
constexpr int kWidths[kLayers - 1] = {1, 2, 4, 8};

bool is_normed(int layer) { return layer > 0 && layer + 1 < kLayers; }

std::string layer_name(std::size_t scale, int layer) {
  return "discriminator_" + std::to_string(scale) + ".model" + std::to_string(layer) +
         (is_normed(layer) ? ".0.0" : ".0");
}

/// Products of a small matrix and a vector: libtorch's own, which are the BLAS's, took 90 ms of a
/// refiner's step.
Tensor rows_with(const Tensor& matrix, const Tensor& vector) { return (matrix * vector).sum(1); }
Tensor columns_with(const Tensor& matrix, const Tensor& vector) {
  return (matrix * vector.unsqueeze(1)).sum(0);
}

/// weight_orig over its largest singular value, as u and v have found it so far.
Tensor spectral_weight(Parameters& p, const std::string& name, bool power) {
  const Tensor& weight = p[name + ".weight_orig"];
  const Tensor matrix = weight.reshape({weight.size(0), -1});
  Tensor u = p[name + ".weight_u"], v = p[name + ".weight_v"];
  if (power) {
    const torch::NoGradGuard guard;
    const auto unit = [](const Tensor& x) { return x / x.norm().clamp_min(1e-12); };
    v.copy_(unit(columns_with(matrix, u)));
    u.copy_(unit(rows_with(matrix, v)));
  }
  // Copies: the next power iteration must not change what backward() needs.
  return weight / (u.clone() * rows_with(matrix, v.clone())).sum();
}

Tensor mean_over_scales(const std::vector<Tensor>& values) { return torch::stack(values).mean(); }

}  // namespace

Discriminator::Discriminator(int d, std::uint64_t seed) : parameters("netD.", seed) {
  for (std::size_t scale = 0; scale < 2; ++scale) {
    int in = 3;
    for (int layer = 0; layer < kLayers; ++layer) {
      const int out = layer + 1 < kLayers ? d * kWidths[layer] : 1;
      const std::string name = layer_name(scale, layer);
      if (is_normed(layer)) {
        parameters.normal(name + ".weight_orig", {out, in, 4, 4}, .05);
        parameters.state(name + ".weight_u", torch::ones({out}) / std::sqrt(out));
        parameters.state(name + ".weight_v", torch::ones({in * 16}) / std::sqrt(in * 16));
      } else {
        add_convolution(parameters, name, in, out, 4, .7);
      }
      in = out;
    }
  }
}

std::array<Discriminator::Maps, 2> Discriminator::forward(const Tensor& image, bool power) {
  std::array<Maps, 2> maps;
  Tensor scaled = image;
  for (std::size_t scale = 0; scale < 2; ++scale) {
    if (scale > 0) scaled = torch::avg_pool2d(scaled, 3, 2, 1, false, false);
    Tensor x = scaled;
    for (int layer = 0; layer < kLayers; ++layer) {
      const std::string name = layer_name(scale, layer);
      const int stride = layer < 3 ? 2 : 1;
      if (is_normed(layer)) {
        x = conv2d(x, spectral_weight(parameters, name, power), {}, stride, 2);
        x = torch::instance_norm(x, {}, {}, {}, {}, true, 0.1, 1e-5, false);
      } else {
        x = convolution(parameters, name, x, stride, 2);
      }
      if (layer + 1 < kLayers) x = torch::leaky_relu(x, 0.2);
      maps[scale].push_back(x);
    }
  }
  return maps;
}

Tensor hinge_of_discriminator(const std::array<Discriminator::Maps, 2>& real,
                              const std::array<Discriminator::Maps, 2>& fake) {
  std::vector<Tensor> losses;
  for (std::size_t s = 0; s < 2; ++s) {
    losses.push_back(torch::relu(1 - real[s].back()).mean() +
                     torch::relu(1 + fake[s].back()).mean());
  }
  return mean_over_scales(losses);
}

Tensor hinge_of_generator(const std::array<Discriminator::Maps, 2>& fake) {
  return -mean_over_scales({fake[0].back().mean(), fake[1].back().mean()});
}

Tensor feature_matching(const std::array<Discriminator::Maps, 2>& real,
                        const std::array<Discriminator::Maps, 2>& fake) {
  std::vector<Tensor> losses;
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t i = 0; i + 1 < real[s].size(); ++i) {
      losses.push_back(torch::l1_loss(fake[s][i], real[s][i].detach()));
    }
  }
  return mean_over_scales(losses);
}

}  // namespace ps::train
