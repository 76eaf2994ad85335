// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/refiner.h"

#include <cmath>
#include <string>

#include "libps/train/layers.h"
#include "libps/train/upsample.h"

namespace ps::train {
namespace {

constexpr int kBlocks = 8;
enum Resample { kSame, kDown, kUp };
constexpr Resample kResample[kBlocks] = {kSame, kDown, kDown, kSame, kUp, kUp, kSame, kSame};
constexpr int kWidths[kBlocks - 1] = {1, 2, 4, 4, 2, 2, 2};

std::string block_name(int i) { return "eblocks." + std::to_string(i) + "."; }

void add_noise_norm(Parameters& p, const std::string& name, int channels) {
  p.normal(name + ".gain.weight", {channels, Refiner::kNoise}, .02);
  p.normal(name + ".bias.weight", {channels, Refiner::kNoise}, .02);
  p.state(name + ".bn.stored_mean", torch::zeros({channels}));
  p.state(name + ".bn.stored_var", torch::ones({channels}));
}

Tensor resample(const Tensor& x, Resample how) {
  if (how == kDown) return torch::avg_pool2d(x, 3, 2, 1);
  return how == kUp ? upsample_2x(x) : x;
}

}  // namespace

Refiner::Refiner(int g, std::uint64_t seed) : parameters("projector.", seed) {
  int in = 4;
  for (int i = 0; i < kBlocks; ++i) {
    const bool last = i + 1 == kBlocks;
    const int out = last ? 3 : g * kWidths[i];
    const double gain = last ? .2 : .7;
    add_noise_norm(parameters, block_name(i) + "ch_a.0", in);
    add_convolution(parameters, block_name(i) + "ch_a.2", in, out, 3);
    add_noise_norm(parameters, block_name(i) + "ch_a.3", out);
    add_convolution(parameters, block_name(i) + "ch_a.5", out, out, 3, gain);
    if (in != out || kResample[i] != kSame) {
      add_convolution(parameters, block_name(i) + "ch_b.0", in, out, 1, gain);
    }
    in = out;
  }
}

Tensor Refiner::noise_norm(const std::string& name, const Tensor& x, torch::Generator& generator,
                           bool training) const {
  const Parameters& p = parameters;
  const Tensor noise = torch::randn({x.size(0), kNoise}, generator).to(x.device());
  const Tensor y = torch::batch_norm(x, {}, {}, p[name + ".bn.stored_mean"],
                                     p[name + ".bn.stored_var"], training, 0.1, 1e-5, false);
  const auto by_channel = [&](const char* which) {
    return noise.matmul(p[name + which].t()).unsqueeze(2).unsqueeze(3);
  };
  return y * (1 + by_channel(".gain.weight")) + by_channel(".bias.weight");
}

Tensor Refiner::forward(const Tensor& input, torch::Generator generator, bool training) const {
  Tensor x = input;
  for (int i = 0; i < kBlocks; ++i) {
    const std::string name = block_name(i);
    Tensor y = torch::relu(noise_norm(name + "ch_a.0", x, generator, training));
    y = torch::relu(noise_norm(name + "ch_a.3", convolution(parameters, name + "ch_a.2", y, 1, 1),
                               generator, training));
    y = resample(convolution(parameters, name + "ch_a.5", y, 1, 1), kResample[i]);
    const bool straight = parameters.trained().count(name + "ch_b.0.weight") > 0;
    x = y +
        (straight ? resample(convolution(parameters, name + "ch_b.0", x, 1, 0), kResample[i]) : x);
  }
  return torch::tanh(x + input.narrow(1, 0, 3));
}

}  // namespace ps::train
