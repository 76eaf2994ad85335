// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/autoencoder.h"

#include <string>
#include <vector>

#include "libps/core/error.h"
#include "libps/models/color_codes.h"
#include "libps/train/checkpoint.h"
#include "libps/train/layers.h"

namespace ps::train {
namespace {

void add_blocks(Parameters& p, const std::string& prefix, int first, int channels, int residual) {
  for (int i = first; i < first + 2; ++i) {
    const std::string name = prefix + std::to_string(i) + ".conv.";
    add_convolution(p, name + "1", channels, residual, 3);
    add_convolution(p, name + "3", residual, channels, 1, .5);
  }
}

/// Two residual blocks and the ReLU behind them; each adds to relu(x), as published.
Tensor blocks(const Parameters& p, const std::string& prefix, int first, Tensor x) {
  for (int i = first; i < first + 2; ++i) {
    const std::string name = prefix + std::to_string(i) + ".conv.";
    x = torch::relu(x);
    const Tensor inner = torch::relu(convolution(p, name + "1", x, 1, 1));
    x = x + convolution(p, name + "3", inner, 1, 0);
  }
  return torch::relu(x);
}

/// [n, e, h, w] as rows of e.
Tensor rows(const Tensor& grid) { return grid.permute({0, 2, 3, 1}).reshape({-1, grid.size(1)}); }

}  // namespace

Autoencoder::Autoencoder(const Widths& w, std::uint64_t seed) : parameters("vqvae.", seed) {
  Parameters& p = parameters;
  const int c = w.channels;
  add_convolution(p, "enc_b.blocks.0", 3, c / 2, 4);
  add_convolution(p, "enc_b.blocks.2", c / 2, c, 4);
  add_convolution(p, "enc_b.blocks.4", c, c, 3);
  add_blocks(p, "enc_b.blocks.", 5, c, w.residual);
  add_convolution(p, "enc_t.blocks.0", c, c / 2, 4);
  add_convolution(p, "enc_t.blocks.2", c / 2, c, 3);
  add_blocks(p, "enc_t.blocks.", 3, c, w.residual);
  add_convolution(p, "quantize_conv_t", c, w.embedding, 1, .7);
  add_transposed(p, "upsample_t", w.embedding, w.embedding, .7);
  add_convolution(p, "dec.blocks.0", w.embedding, c, 3);
  add_blocks(p, "dec.blocks.", 1, c, w.residual);
  add_transposed(p, "dec.blocks.4", c, c / 2);
  add_transposed(p, "dec.blocks.6", c / 2, 3, .3);
  const Tensor embed = torch::randn({w.embedding, w.codes}, generator_of(seed, -2)) * .1;
  p.state("quantize_t.embed", embed);
  p.state("quantize_t.embed_avg", embed.clone());
  p.state("quantize_t.cluster_size", torch::ones({w.codes}));
}

Tensor Autoencoder::encode(const Tensor& image) const {
  const Parameters& p = parameters;
  Tensor x = torch::relu(convolution(p, "enc_b.blocks.0", image, 2, 1));
  x = torch::relu(convolution(p, "enc_b.blocks.2", x, 2, 1));
  x = blocks(p, "enc_b.blocks.", 5, convolution(p, "enc_b.blocks.4", x, 1, 1));
  x = torch::relu(convolution(p, "enc_t.blocks.0", x, 2, 1));
  x = blocks(p, "enc_t.blocks.", 3, convolution(p, "enc_t.blocks.2", x, 1, 1));
  return convolution(p, "quantize_conv_t", x, 1, 0);
}

Tensor Autoencoder::decode(const Tensor& grid) const {
  const Parameters& p = parameters;
  Tensor x = convolution(p, "dec.blocks.0", transposed(p, "upsample_t", grid), 1, 1);
  x = torch::relu(transposed(p, "dec.blocks.4", blocks(p, "dec.blocks.", 1, x)));
  return transposed(p, "dec.blocks.6", x);
}

Tensor Autoencoder::nearest(const Tensor& pre_quant) const {
  const torch::NoGradGuard guard;
  const Tensor& embed = parameters["quantize_t.embed"];
  const Tensor kernel = embed.t().contiguous().unsqueeze(2).unsqueeze(3) * 2;
  const Tensor twice = torch::conv2d(pre_quant.detach(), kernel);
  return (twice - embed.square().sum(0).view({1, -1, 1, 1})).argmax(1);
}

Tensor Autoencoder::embed(const Tensor& codes) const {
  const Tensor by_code = parameters["quantize_t.embed"].t().contiguous();
  const Tensor values = by_code.index_select(0, codes.reshape({-1}));
  return values.view({codes.size(0), codes.size(1), codes.size(2), -1}).permute({0, 3, 1, 2});
}

void Autoencoder::move_codebook(const Tensor& pre_quant, const Tensor& codes,
                                torch::Generator generator) {
  const torch::NoGradGuard guard;
  constexpr double kDecay = 0.99, kEps = 1e-5;
  const Tensor x = rows(pre_quant.detach());
  Tensor embed = parameters["quantize_t.embed"], sums = parameters["quantize_t.embed_avg"],
         counts = parameters["quantize_t.cluster_size"];
  const auto n_codes = counts.size(0);
  const Tensor flat = codes.reshape({-1});
  const Tensor found = torch::bincount(flat, {}, n_codes).to(counts.dtype());
  const Tensor found_sums = torch::zeros({n_codes, x.size(1)}, x.options()).index_add_(0, flat, x);
  counts.lerp_(found, 1 - kDecay);
  sums.lerp_(found_sums.t(), 1 - kDecay);
  const Tensor dead =
      counts < kDead * static_cast<double>(x.size(0)) / static_cast<double>(n_codes);
  const auto index = dead.nonzero().view({-1});
  if (index.numel() > 0) {
    const Tensor at = torch::randint(x.size(0), {index.numel()}, generator,
                                     torch::TensorOptions().dtype(torch::kInt64));
    const double fair = static_cast<double>(x.size(0)) / static_cast<double>(n_codes);
    counts.index_fill_(0, index, fair);
    sums.index_copy_(1, index, x.index_select(0, at.to(x.device())).t() * fair);
  }
  const Tensor total = counts.sum();
  const Tensor smoothed = (counts + kEps) / (total + static_cast<double>(n_codes) * kEps) * total;
  embed.copy_(sums / smoothed.unsqueeze(0));
}

namespace {

TensorsByName tensors_of_colors() {
  TensorsByName tensors;
  const nn::Weights weights = models::color_codes();
  for (const auto& [name, tensor] : weights.tensors()) {
    const std::vector<std::int64_t> shape(tensor.shape.begin(), tensor.shape.end());
    tensors[name] = torch::tensor(tensor.values).view(shape);
  }
  return tensors;
}

}  // namespace

Autoencoder read_autoencoder(const std::filesystem::path& path, torch::Device device) {
  const std::string where = path.string();
  if (path.empty())
    throw Error("--codes", "there are no weights of a VQ-VAE", "what `train vqvae` made");
  const TensorsByName tensors = where == kColors ? tensors_of_colors() : read_tensors(path);
  const auto side = [&](const char* name, int axis) {
    const auto found = tensors.find(name);
    if (found == tensors.end() || found->second.dim() <= axis) {
      throw Error(where, std::string("there is no ") + name, "weights of a VQ-VAE");
    }
    return static_cast<int>(found->second.size(axis));
  };
  Autoencoder net(
      {side("vqvae.enc_b.blocks.4.weight", 0), side("vqvae.enc_b.blocks.5.conv.1.weight", 0),
       side("vqvae.quantize_t.embed", 0), side("vqvae.quantize_t.embed", 1)},
      0);
  net.parameters.load(tensors, where);
  net.parameters.to(device);
  return net;
}

}  // namespace ps::train
