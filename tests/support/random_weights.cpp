// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/random_weights.h"

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace ps::models {
namespace {

using Shape = std::vector<int>;

/// Tensors by name, under a prefix.
class Maker {
 public:
  explicit Maker(std::string prefix) : prefix_(std::move(prefix)) {}

  nn::Weights weights() && { return {"random weights", std::move(tensors_)}; }

  /// Values of [least, most).
  void tensor(const std::string& name, const Shape& shape, double least, double most) {
    nn::WeightTensor tensor;
    for (const int side : shape) tensor.shape.push_back(static_cast<std::size_t>(side));
    for (std::size_t i = tensor.elements(); i > 0; --i) {
      tensor.values.push_back(static_cast<float>(least + (most - least) * next()));
    }
    tensors_[prefix_ + name] = std::move(tensor);
  }

  /// Weights that make about `gain` of the size of signals, half of which ReLU has cut off.
  void layer(const std::string& name, const Shape& shape, int fan_in, double gain = 1,
             const char* suffix = ".weight") {
    const double reach = gain * std::sqrt(6.0 / fan_in);
    tensor(name + suffix, shape, -reach, reach);
  }
  void bias(const std::string& name, int count) { tensor(name + ".bias", {count}, -.1, .1); }

  void convolution(const std::string& name, int in, int out, int kernel, double gain = 1) {
    layer(name, {out, in, kernel, kernel}, in * kernel * kernel, gain);
    bias(name, out);
  }
  void transposed(const std::string& name, int in, int out, double gain = 1) {
    layer(name, {in, out, 4, 4}, in * 4, gain);
    bias(name, out);
  }
  /// A linear layer with weight norm.
  void normed(const std::string& name, int in, int out) {
    layer(name, {out, in}, in, 1, ".weight_v");
    tensor(name + ".weight_g", {out, 1}, .5, 1.5);
    bias(name, out);
  }
  /// Of signals of about unit size; `gain` of it afterwards.
  void batch_norm(const std::string& name, int channels, double gain = 1) {
    tensor(name + ".weight", {channels}, .8 * gain, 1.2 * gain);
    bias(name, channels);
    tensor(name + ".running_mean", {channels}, -.1, .1);
    tensor(name + ".running_var", {channels}, .7, 1.3);
  }
  void noise_norm(const std::string& name, int channels) {
    constexpr int kNoise = 20;
    layer(name + ".gain", {channels, kNoise}, kNoise, .1);
    layer(name + ".bias", {channels, kNoise}, kNoise, .1);
    tensor(name + ".bn.stored_mean", {channels}, -.1, .1);
    tensor(name + ".bn.stored_var", {channels}, .7, 1.3);
  }

 private:
  double next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  std::string prefix_;
  std::map<std::string, nn::WeightTensor> tensors_;
  std::mt19937_64 engine_{1};
};

std::string text(int number) { return std::to_string(number); }

}  // namespace

nn::Weights random_depth_net(int f) {
  Maker make("pts_regressor.");
  const Shape encoder = {3, f, 2 * f, 4 * f, 8 * f, 8 * f, 8 * f, 8 * f, 8 * f};
  for (int i = 1; i <= 8; ++i) {
    make.convolution("conv" + text(i), encoder[i - 1], encoder[i], 4);
  }
  const Shape decoder = {8 * f, 8 * f, 8 * f, 8 * f, 4 * f, 2 * f, f, 1};
  for (int i = 1; i <= 8; ++i) {
    const int in = i == 1 ? 8 * f : decoder[i - 2] + encoder[9 - i];
    make.convolution("dconv" + text(i), in, decoder[i - 1], 3);
  }
  make.batch_norm("batch_norm", f);
  for (int i = 0; i < 2; ++i) make.batch_norm("batch_norm2_" + text(i), 2 * f);
  for (int i = 0; i < 2; ++i) make.batch_norm("batch_norm4_" + text(i), 4 * f);
  for (int i = 0; i < 8; ++i) make.batch_norm("batch_norm8_" + text(i), 8 * f);
  return std::move(make).weights();
}

nn::Weights random_autoencoder(int c, int embedding, int residual, int codes) {
  Maker make("vqvae.");
  const auto blocks = [&](const std::string& name, int first) {
    for (int i = first; i < first + 2; ++i) {
      make.convolution(name + text(i) + ".conv.1", c, residual, 3);
      make.convolution(name + text(i) + ".conv.3", residual, c, 1, .3);
    }
  };
  make.convolution("enc_b.blocks.0", 3, c / 2, 4);
  make.convolution("enc_b.blocks.2", c / 2, c, 4);
  make.convolution("enc_b.blocks.4", c, c, 3);
  blocks("enc_b.blocks.", 5);
  make.convolution("enc_t.blocks.0", c, c / 2, 4);
  make.convolution("enc_t.blocks.2", c / 2, c, 3);
  blocks("enc_t.blocks.", 3);
  make.convolution("quantize_conv_t", c, embedding, 1);
  make.tensor("quantize_t.embed", {embedding, codes}, -1.7, 1.7);
  make.transposed("upsample_t", embedding, embedding, .7);
  make.convolution("dec.blocks.0", embedding, c, 3);
  blocks("dec.blocks.", 1);
  make.transposed("dec.blocks.4", c, c / 2);
  make.transposed("dec.blocks.6", c / 2, 3, .3);
  return std::move(make).weights();
}

nn::Weights random_pixel_cnn(int f, int codes) {
  Maker make("outpaint2.");
  make.layer("u_init", {f, codes + 1, 3, 3}, 18);
  make.bias("u_init", f);
  const int blocks[2][3] = {{2, 2, 2}, {2, 3, 3}};
  for (int down = 0; down < 2; ++down) {
    for (int s = 0; s < 3; ++s) {
      for (int b = 0; b < blocks[down][s]; ++b) {
        const std::string name =
            (down ? "down_layers." : "up_layers.") + text(s) + ".u_stream." + text(b) + ".";
        make.convolution(name + "conv_input", 2 * f, f, 3);
        if (down) make.normed(name + "nin_skip.lin_a", 2 * f, f);
        make.convolution(name + "conv_out", 2 * f, 2 * f, 3);
      }
      const std::string between = down ? "upsize_u_stream." : "downsize_u_stream.";
      if (s < 2) make.convolution(between + text(s), f, f, 3);
    }
  }
  make.normed("nin_out.lin_a", f, codes);
  return std::move(make).weights();
}

nn::Weights random_refiner(int g) {
  Maker make("projector.");
  const Shape widths = {4, g, 2 * g, 4 * g, 4 * g, 2 * g, 2 * g, 2 * g, 3};
  for (int i = 0; i < 8; ++i) {
    const std::string name = "eblocks." + text(i) + ".";
    const int in = widths[i], out = widths[i + 1];
    make.noise_norm(name + "ch_a.0", in);
    make.convolution(name + "ch_a.2", in, out, 3);
    make.noise_norm(name + "ch_a.3", out);
    make.convolution(name + "ch_a.5", out, out, 3, i < 7 ? .5 : .2);
    if (i != 3 && i != 6) make.convolution(name + "ch_b.0", in, out, 1, i < 7 ? .6 : .2);
  }
  return std::move(make).weights();
}

nn::Weights random_discriminator(int d) {
  Maker make("netD.");
  const Shape widths = {3, d, 2 * d, 4 * d, 8 * d, 1};
  for (int s = 0; s < 2; ++s) {
    for (int i = 0; i < 5; ++i) {
      const bool normed = i > 0 && i < 4;
      const std::string name =
          "discriminator_" + text(s) + ".model" + text(i) + (normed ? ".0.0" : ".0");
      make.layer(name, {widths[i + 1], widths[i], 4, 4}, widths[i] * 16);
      if (!normed) make.bias(name, widths[i + 1]);
    }
  }
  return std::move(make).weights();
}

nn::Weights random_classifier(int width, int classes) {
  Maker make("classifier.");
  const auto normed = [&](const std::string& name, const std::string& norm, int in, int out,
                          int kernel, double gain) {
    make.layer(name, {out, in, kernel, kernel}, in * kernel * kernel);
    make.batch_norm(norm, out, gain);
  };
  normed("conv1", "bn1", 3, width, 7, 1);
  int in = width;
  for (int stage = 1; stage <= 4; ++stage) {
    const int out = width << (stage - 1);
    for (int i = 0; i < 2; ++i, in = out) {
      const std::string name = "layer" + text(stage) + "." + text(i) + ".";
      normed(name + "conv1", name + "bn1", in, out, 3, 1);
      normed(name + "conv2", name + "bn2", out, out, 3, .5);
      if (in != out) normed(name + "downsample.0", name + "downsample.1", in, out, 1, .7);
    }
  }
  make.layer("fc", {classes, in}, in);
  make.bias("fc", classes);
  return std::move(make).weights();
}

nn::Weights random_lpips(int divisor) {
  Maker make("");
  int in = 64 / divisor;
  make.convolution("net.0", 3, in, 3);
  make.tensor("lin0.model.1.weight", {1, in, 1, 1}, 0, 1);
  const int places[8][4] = {{3, 16, 64, 0},  {4, 16, 64, 1},   {6, 32, 128, 0},  {7, 32, 128, 2},
                            {9, 48, 192, 3}, {10, 48, 192, 4}, {11, 64, 256, 5}, {12, 64, 256, 6}};
  for (const auto& [index, narrow, wide, compared] : places) {
    const std::string name = "net." + text(index) + ".";
    make.convolution(name + "squeeze", in, narrow / divisor, 1);
    make.convolution(name + "expand1x1", narrow / divisor, wide / divisor, 1);
    make.convolution(name + "expand3x3", narrow / divisor, wide / divisor, 3);
    in = 2 * (wide / divisor);
    if (compared) {
      make.tensor("lin" + text(compared) + ".model.1.weight", {1, in, 1, 1}, 0, 1);
    }
  }
  return std::move(make).weights();
}

}  // namespace ps::models
