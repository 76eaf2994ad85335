// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/color_codes.h"

#include <map>
#include <string>
#include <utility>

namespace ps::models {
namespace {

using Tensors = std::map<std::string, nn::WeightTensor>;

constexpr std::size_t kColors = 3, kChannels = 6, kLevels = 8;
constexpr std::size_t kCodes = kLevels * kLevels * kLevels;

std::vector<float>& zeros(Tensors& tensors, const std::string& name,
                          const std::vector<std::size_t>& shape) {
  nn::WeightTensor tensor;
  tensor.shape = shape;
  tensor.values.assign(tensor.elements(), 0.f);
  return (tensors["vqvae." + name] = std::move(tensor)).values;
}

/// A convolution that passes red, green and blue on, each tap of the middle square `side` wide
/// times `gain`.
void pass_on(Tensors& tensors, const std::string& name, std::size_t first, std::size_t second,
             std::size_t kernel, std::size_t side, float gain, std::size_t out, float bias = 0) {
  auto& weight = zeros(tensors, name + ".weight", {first, second, kernel, kernel});
  const std::size_t from = (kernel - side) / 2;
  for (std::size_t c = 0; c < kColors; ++c) {
    for (std::size_t y = from; y < from + side; ++y) {
      for (std::size_t x = from; x < from + side; ++x) {
        weight[((c * second + c) * kernel + y) * kernel + x] = gain;
      }
    }
  }
  auto& biases = zeros(tensors, name + ".bias", {out});
  for (std::size_t c = 0; c < kColors; ++c) biases[c] = bias;
}

/// The mean of 2x2 pixels.
void halve(Tensors& tensors, const std::string& name, std::size_t out, std::size_t in,
           float bias = 0) {
  pass_on(tensors, name, out, in, 4, 2, .25f, out, bias);
}

/// Each pixel four times. A transposed convolution's weight has its inputs first.
void twice(Tensors& tensors, const std::string& name, std::size_t in, std::size_t out,
           float bias = 0) {
  pass_on(tensors, name, in, out, 4, 2, 1, out, bias);
}

/// Residual blocks that add nothing.
void nothing(Tensors& tensors, const std::string& prefix, int first) {
  for (int i = first; i < first + 2; ++i) {
    const std::string name = prefix + std::to_string(i) + ".conv.";
    zeros(tensors, name + "1.weight", {1, kChannels, 3, 3});
    zeros(tensors, name + "1.bias", {1});
    zeros(tensors, name + "3.weight", {kChannels, 1, 1, 1});
    zeros(tensors, name + "3.bias", {kChannels});
  }
}

void add_codebook(Tensors& tensors) {
  auto& embed = zeros(tensors, "quantize_t.embed", {kColors, kCodes});
  for (std::size_t code = 0; code < kCodes; ++code) {
    const std::size_t levels[kColors] = {code / (kLevels * kLevels), code / kLevels % kLevels,
                                         code % kLevels};
    for (std::size_t c = 0; c < kColors; ++c) {
      embed[c * kCodes + code] = (2 * static_cast<float>(levels[c]) + 1) / kLevels - 1;
    }
  }
  zeros(tensors, "quantize_t.embed_avg", {kColors, kCodes}) = embed;
  zeros(tensors, "quantize_t.cluster_size", {kCodes}).assign(kCodes, 1.f);
}

}  // namespace

nn::Weights color_codes() {
  constexpr std::size_t kHalf = kChannels / 2;
  Tensors tensors;
  // From [-1,1] to [0,2], which ReLUs pass, and back at the end.
  halve(tensors, "enc_b.blocks.0", kHalf, kColors, 1);
  halve(tensors, "enc_b.blocks.2", kChannels, kHalf);
  pass_on(tensors, "enc_b.blocks.4", kChannels, kChannels, 3, 1, 1, kChannels);
  nothing(tensors, "enc_b.blocks.", 5);
  halve(tensors, "enc_t.blocks.0", kHalf, kChannels);
  pass_on(tensors, "enc_t.blocks.2", kChannels, kHalf, 3, 1, 1, kChannels);
  nothing(tensors, "enc_t.blocks.", 3);
  pass_on(tensors, "quantize_conv_t", kColors, kChannels, 1, 1, 1, kColors, -1);
  add_codebook(tensors);
  twice(tensors, "upsample_t", kColors, kColors, 1);
  pass_on(tensors, "dec.blocks.0", kChannels, kColors, 3, 1, 1, kChannels);
  nothing(tensors, "dec.blocks.", 1);
  twice(tensors, "dec.blocks.4", kChannels, kHalf);
  twice(tensors, "dec.blocks.6", kHalf, kColors, -1);
  return {"colours", std::move(tensors)};
}

}  // namespace ps::models
