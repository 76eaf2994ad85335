// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/autoencoder.h"

#include <string>

#include "libps/models/layers.h"

namespace ps::models {
namespace {

constexpr char kName[] = "Autoencoder";

ConvolutionSpec halving(int in) {
  ConvolutionSpec spec;
  spec.in = in;
  spec.kernel = 4;
  spec.stride = 2;
  spec.padding = 1;
  return spec;
}

ConvolutionSpec same_size(int in, int out = 0) {
  ConvolutionSpec spec;
  spec.in = in;
  spec.out = out;
  spec.padding = 1;
  return spec;
}

ConvolutionSpec pointwise(int in, int out = 0) {
  ConvolutionSpec spec = same_size(in, out);
  spec.kernel = 1;
  spec.padding = 0;
  return spec;
}

}  // namespace

void ResidualBlock::operator()(const nn::TensorView& x, nn::Workspace& workspace) const {
  const nn::Workspace::Scope scope(workspace);
  const nn::TensorView inner = workspace.take(narrow.output(x.shape));
  narrow(x, inner, workspace, activated(nn::kRelu));
  nn::Epilogue add = activated(nn::kRelu);
  add.residual = &x;
  wide(inner, x, workspace, add);
}

std::vector<ResidualBlock> Autoencoder::read_blocks(const Layers& layers, const std::string& prefix,
                                                    int first, int channels) {
  std::vector<ResidualBlock> blocks;
  for (int i = first; i < first + 2; ++i) {
    const std::string name = prefix + std::to_string(i) + ".conv.";
    nn::Convolution narrow = layers.convolution(name + "1", same_size(channels));
    nn::Convolution wide =
        layers.convolution(name + "3", pointwise(narrow.out_channels(), channels));
    blocks.push_back({std::move(narrow), std::move(wide)});
  }
  return blocks;
}

Autoencoder::Encoder Autoencoder::read_encoder(const Layers& layers) {
  nn::Convolution half = layers.convolution("enc_b.blocks.0", halving(3));
  nn::Convolution quarter = layers.convolution("enc_b.blocks.2", halving(half.out_channels()));
  const int channels = quarter.out_channels();
  nn::Convolution mix = layers.convolution("enc_b.blocks.4", same_size(channels, channels));
  nn::Convolution eighth = layers.convolution("enc_t.blocks.0", halving(channels));
  nn::Convolution mix_top =
      layers.convolution("enc_t.blocks.2", same_size(eighth.out_channels(), channels));
  return {std::move(half),
          std::move(quarter),
          std::move(mix),
          read_blocks(layers, "enc_b.blocks.", 5, channels),
          std::move(eighth),
          std::move(mix_top),
          read_blocks(layers, "enc_t.blocks.", 3, channels),
          layers.convolution("quantize_conv_t", pointwise(channels))};
}

Autoencoder::Decoder Autoencoder::read_decoder(const Layers& layers, int channels) {
  nn::Convolution mix = layers.convolution("dec.blocks.0", same_size(channels));
  const int wide = mix.out_channels();
  nn::TransposedConvolution half = layers.transposed("dec.blocks.4", wide, 0);
  nn::TransposedConvolution whole = layers.transposed("dec.blocks.6", half.out_channels(), 3);
  return {layers.transposed("upsample_t", channels, channels), std::move(mix),
          read_blocks(layers, "dec.blocks.", 1, wide), std::move(half), std::move(whole)};
}

Autoencoder::Autoencoder(const nn::Weights& weights, const ModelOptions& options)
    : Autoencoder(Layers(weights, "vqvae.", options)) {}

Autoencoder::Autoencoder(const Layers& layers)
    : encoder_(read_encoder(layers)),
      codebook_(layers.tensor("quantize_t.embed", {encoder_.to_embedding.out_channels(), 0})),
      decoder_(read_decoder(layers, codebook_.channels())) {}

nn::Shape Autoencoder::grid(const nn::Shape& image) const {
  return {image.images, image.height / kCell, image.width / kCell, channels()};
}

void Autoencoder::encode(const nn::TensorView& image, const nn::TensorView& pre_quant,
                         nn::Workspace& workspace) const {
  check_image(kName, image, 3, kCell);
  check_shape(kName, "pre_quant", pre_quant, grid(image.shape));
  const nn::Epilogue relu = activated(nn::kRelu);
  const nn::Workspace::Scope scope(workspace);
  const nn::Shape half = encoder_.half.output(image.shape), quarter = encoder_.quarter.output(half),
                  eighth = encoder_.eighth.output(quarter);
  const nn::TensorView top = workspace.take(encoder_.mix_top.output(eighth));
  {
    const nn::Workspace::Scope bottom(workspace);
    const nn::TensorView x = workspace.take(quarter), mixed = workspace.take(quarter);
    {
      const nn::Workspace::Scope first(workspace);
      const nn::TensorView y = workspace.take(half);
      encoder_.half(image, y, workspace, relu);
      encoder_.quarter(y, x, workspace, relu);
    }
    encoder_.mix(x, mixed, workspace, relu);
    for (const ResidualBlock& block : encoder_.blocks) block(mixed, workspace);
    const nn::TensorView y = workspace.take(eighth);
    encoder_.eighth(mixed, y, workspace, relu);
    encoder_.mix_top(y, top, workspace, relu);
  }
  for (const ResidualBlock& block : encoder_.top_blocks) block(top, workspace);
  encoder_.to_embedding(top, pre_quant, workspace);
}

void Autoencoder::encode(const nn::TensorView& image, std::int32_t* codes,
                         nn::Workspace& workspace) const {
  check_image(kName, image, 3, kCell);
  const nn::Workspace::Scope scope(workspace);
  const nn::TensorView pre_quant = workspace.take(grid(image.shape));
  encode(image, pre_quant, workspace);
  quantise(pre_quant, codes);
}

void Autoencoder::decode(const std::int32_t* codes, const nn::TensorView& image,
                         nn::Workspace& workspace) const {
  check_image(kName, image, 3, kCell);
  const nn::Epilogue relu = activated(nn::kRelu);
  const nn::Workspace::Scope scope(workspace);
  const nn::Shape eighth = grid(image.shape), quarter = decoder_.quarter.output(eighth),
                  mixed = decoder_.mix.output(quarter);
  const nn::TensorView half = workspace.take(decoder_.half.output(mixed));
  {
    const nn::Workspace::Scope first(workspace);
    const nn::TensorView embedded = workspace.take(eighth), x = workspace.take(quarter),
                         y = workspace.take(mixed);
    codebook_.embed(codes, embedded);
    decoder_.quarter(embedded, x);
    decoder_.mix(x, y, workspace, relu);
    for (const ResidualBlock& block : decoder_.blocks) block(y, workspace);
    decoder_.half(y, half, relu);
  }
  decoder_.whole(half, image);
}

}  // namespace ps::models
