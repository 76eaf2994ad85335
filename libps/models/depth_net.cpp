// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/depth_net.h"

#include <algorithm>
#include <string>

#include "libps/core/parallel.h"
#include "libps/models/layers.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/resample.h"

namespace ps::models {
namespace {

constexpr int kTaps = 9;
/// A 3x3 convolution to one channel as a matrix that keeps its nine products apart.
nn::WeightTensor taps_apart(const nn::WeightTensor& weight) {
  const std::size_t in = weight.shape[1];
  nn::WeightTensor apart{{kTaps, in}, std::vector<float>(kTaps * in)};
  for (std::size_t c = 0; c < in; ++c) {
    for (std::size_t t = 0; t < kTaps; ++t) {
      apart.values[t * in + c] = weight.values[c * kTaps + t];
    }
  }
  return apart;
}

/// out(y, x) = bias + the sum over taps t of taps(y + t / 3 - 1, x + t % 3 - 1)[t], zeros outside.
void sum_taps(const nn::TensorView& taps, float bias, const nn::TensorView& out) {
  const nn::Shape shape = out.shape;
  const auto height = static_cast<std::size_t>(shape.height);
  parallel_for(height * static_cast<std::size_t>(shape.images), [&](std::size_t row) {
    const int image = static_cast<int>(row / height), y = static_cast<int>(row % height);
    for (int x = 0; x < shape.width; ++x) *out.pixel(image, y, x) = bias;
    for (int t = 0; t < kTaps; ++t) {
      const int from = y + t / 3 - 1, dx = t % 3 - 1;
      if (from < 0 || from >= shape.height) continue;
      const int end = std::min(shape.width, shape.width - dx);
      for (int x = std::max(0, -dx); x < end; ++x) {
        *out.pixel(image, y, x) += taps.pixel(image, from, x + dx)[t];
      }
    }
  });
}

std::vector<nn::Convolution> read_encoder(const Layers& layers) {
  std::vector<nn::Convolution> encoder;
  ConvolutionSpec spec;
  spec.in = 3;
  spec.kernel = 4;
  spec.stride = 2;
  spec.padding = 1;
  for (const char* norm : DepthNet::kEncoderNorms) {
    encoder.push_back(layers.convolution("conv" + std::to_string(encoder.size() + 1), spec, norm));
    spec.in = encoder.back().out_channels();
  }
  return encoder;
}

std::vector<nn::Convolution> read_decoder(const Layers& layers,
                                          const std::vector<nn::Convolution>& encoder) {
  std::vector<nn::Convolution> decoder;
  ConvolutionSpec spec;
  spec.in = encoder.back().out_channels();
  spec.padding = 1;
  for (const char* norm : DepthNet::kDecoderNorms) {
    decoder.push_back(layers.convolution("dconv" + std::to_string(decoder.size() + 1), spec, norm));
    spec.in =
        decoder.back().out_channels() + encoder[encoder.size() - 1 - decoder.size()].out_channels();
  }
  return decoder;
}

}  // namespace

DepthNet::DepthNet(const nn::Weights& weights, const ModelOptions& options)
    : DepthNet(Layers(weights, "pts_regressor.", options), options.storage) {}

DepthNet::DepthNet(const Layers& layers, nn::Storage storage)
    : encoder_(read_encoder(layers)),
      decoder_(read_decoder(layers, encoder_)),
      last_(taps_apart(layers.weight(
                "dconv8", {1, decoder_.back().out_channels() + encoder_[0].out_channels(), 3, 3})),
            {}, storage),
      last_bias_(layers.vector("dconv8.bias", 1)[0]) {}

void DepthNet::encode(const nn::TensorView& image, const Skips& skips,
                      nn::Workspace& workspace) const {
  for (std::size_t k = 0; k < kLevels; ++k) {
    const nn::TensorView& in = k == 0 ? image : skips[k - 1];
    encoder_[k](in, skips[k], workspace, activated(k + 1 < kLevels ? nn::kLeakyRelu : nn::kRelu));
    // The decoder reads relu(x) of a skip, which is relu(leaky(x)).
    if (k > 0) nn::activate(in, in, nn::kRelu);
  }
}

void DepthNet::forward(const nn::TensorView& image, const nn::TensorView& raw,
                       nn::Workspace& workspace) const {
  check_image("DepthNet", image, encoder_[0].in_channels(), kMultiple);
  nn::Shape shape = image.shape;
  shape.channels = 1;
  check_shape("DepthNet", "raw", raw, shape);
  const nn::Workspace::Scope scope(workspace);
  // At each level, the channels that the decoder made there and those of the encoder; its last
  // level has the encoder's alone. All are stored activated.
  std::array<nn::TensorView, kLevels> levels;
  Skips skips;
  for (std::size_t k = 0; k < kLevels; ++k) {
    const int own = encoder_[k].out_channels();
    const int made = k + 1 < kLevels ? decoder_[kLevels - 2 - k].out_channels() : 0;
    levels[k] =
        workspace.take({shape.images, shape.height >> (k + 1), shape.width >> (k + 1), made + own});
    skips[k] = levels[k].channels(made, own);
  }
  encode(image, skips, workspace);
  for (std::size_t k = kLevels - 1; k > 0; --k) {
    const nn::Workspace::Scope step(workspace);
    const nn::Convolution& convolution = decoder_[kLevels - 1 - k];
    nn::Shape doubled = levels[k - 1].shape;
    doubled.channels = levels[k].shape.channels;
    const nn::TensorView up = workspace.take(doubled);
    nn::upsample_bilinear_2x(levels[k], up);
    convolution(up, levels[k - 1].channels(0, convolution.out_channels()), workspace,
                activated(nn::kRelu));
  }
  // Doubling is linear and alike for all channels: after the products, nine channels are doubled
  // in place of 2f.
  nn::Shape taps = levels[0].shape;
  taps.channels = kTaps;
  const nn::TensorView products = workspace.take(taps);
  last_(levels[0], products);
  shape.channels = kTaps;
  const nn::TensorView doubled = workspace.take(shape);
  nn::upsample_bilinear_2x(products, doubled);
  sum_taps(doubled, last_bias_, raw);
}

void depth_of_raw(const nn::TensorView& raw, float min_z, float max_z,
                  const nn::TensorView& depth) {
  nn::sigmoid(raw, depth);
  const std::vector<float> scale(static_cast<std::size_t>(raw.shape.channels), max_z - min_z);
  const std::vector<float> shift(scale.size(), min_z);
  nn::scale_shift(depth, scale.data(), shift.data(), depth);
}

}  // namespace ps::models
