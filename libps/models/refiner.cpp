// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/refiner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "libps/models/layers.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/resample.h"

namespace ps::models {
namespace {

constexpr char kName[] = "Refiner";
constexpr double kEps = 1e-5;
constexpr int kImageChannels = 3;

/// @param noise  width of the noise: 0 before the first norm is read, which sets it for all others
NoiseNorm read_norm(const Layers& layers, const std::string& name, int channels, int& noise) {
  const nn::WeightTensor gain = layers.weight(name + ".gain", {channels, noise});
  noise = static_cast<int>(gain.shape[1]);
  return {gain, layers.weight(name + ".bias", {channels, noise}),
          layers.vector(name + ".bn.stored_mean", channels),
          layers.variance(name + ".bn.stored_var", channels)};
}

float dot(const float* a, const float* b, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += static_cast<double>(a[i]) * b[i];
  return static_cast<float>(sum);
}

}  // namespace

NoiseNorm::NoiseNorm(const nn::WeightTensor& gain, const nn::WeightTensor& bias,
                     std::vector<float> mean, const std::vector<float>& variance)
    : gain_(gain.values), bias_(bias.values), mean_(std::move(mean)) {
  for (const float v : variance) {
    inverse_deviation_.push_back(static_cast<float>(1 / std::sqrt(v + kEps)));
  }
}

void NoiseNorm::apply(const float* noise, float* scale, float* shift) const {
  const std::size_t count = gain_.size() / mean_.size();
  for (std::size_t c = 0; c < mean_.size(); ++c) {
    scale[c] = (1 + dot(&gain_[c * count], noise, count)) * inverse_deviation_[c];
    shift[c] = dot(&bias_[c * count], noise, count) - mean_[c] * scale[c];
  }
}

std::vector<Refiner::Block> Refiner::read_blocks(const Layers& layers) {
  constexpr std::array<Resample, 8> kResample = {Resample::none, Resample::down, Resample::down,
                                                 Resample::none, Resample::up,   Resample::up,
                                                 Resample::none, Resample::none};
  std::vector<Block> blocks;
  int in = kImageChannels + 1, noise = 0;
  for (std::size_t i = 0; i < kResample.size(); ++i) {
    const std::string name = "eblocks." + std::to_string(i) + ".";
    ConvolutionSpec spec;
    spec.in = in;
    spec.out = i + 1 < kResample.size() ? 0 : kImageChannels;
    spec.padding = 1;
    nn::Convolution convolution1 = layers.convolution(name + "ch_a.2", spec);
    const int out = convolution1.out_channels();
    std::optional<nn::Convolution> straight;
    std::vector<float> straight_bias;
    if (in != out || kResample[i] != Resample::none) {
      straight = layers.convolution(name + "ch_b.0", {in, out, 1, 1, 0, false});
      straight_bias = layers.vector(name + "ch_b.0.bias", out);
    }
    spec.in = spec.out = out;
    nn::Convolution convolution2 = layers.convolution(name + "ch_a.5", spec, "", straight_bias);
    NoiseNorm norm1 = read_norm(layers, name + "ch_a.0", in, noise);
    NoiseNorm norm2 = read_norm(layers, name + "ch_a.3", out, noise);
    blocks.push_back({std::move(norm1), std::move(convolution1), std::move(norm2),
                      std::move(convolution2), std::move(straight), kResample[i]});
    in = out;
  }
  return blocks;
}

Refiner::Refiner(const nn::Weights& weights, const ModelOptions& options, Output output)
    : blocks_(read_blocks(Layers(weights, "projector.", options))), output_(output) {}

std::size_t Refiner::noise_count() const {
  int count = 0;
  for (const Block& block : blocks_) count += block.noise();
  return static_cast<std::size_t>(count);
}

nn::Shape Refiner::Block::output(const nn::Shape& in) const {
  nn::Shape out = in;
  if (resample == Resample::down) out = nn::half_size(in);
  if (resample == Resample::up) out = {in.images, 2 * in.height, 2 * in.width, 0};
  out.channels = convolution2.out_channels();
  return out;
}

/// Resampling is linear, so both paths are added before it, or the 1x1 path goes after it where
/// that is less work; convolution2 has its bias in either case.
/// @param added  of the output's shape, added to it; null = nothing
void Refiner::run(const Block& block, const nn::TensorView& x, const float* noise,
                  const nn::TensorView* added, const nn::TensorView& out,
                  nn::Workspace& workspace) {
  const nn::Workspace::Scope scope(workspace);
  const auto in = static_cast<std::size_t>(block.norm1.channels()),
             inner = static_cast<std::size_t>(block.norm2.channels());
  float* const norm1 = workspace.take(2 * in);
  float* const norm2 = workspace.take(2 * inner);
  block.norm1.apply(noise, norm1, norm1 + in);
  block.norm2.apply(noise + block.norm1.noise(), norm2, norm2 + inner);
  const nn::TensorView y = workspace.take(block.convolution1.output(x.shape));
  nn::Epilogue between = activated(nn::kRelu), end;
  between.scale = norm2;
  between.shift = norm2 + inner;
  block.convolution1(x, y, workspace, between, {norm1, norm1 + in});

  nn::Epilogue straight;
  straight.residual = added;
  if (block.resample == Resample::none) {
    if (block.straight) (*block.straight)(x, out, workspace, straight);
    end.residual = block.straight ? &out : &x;
    block.convolution2(y, out, workspace, end);
    return;
  }
  const nn::TensorView sum = workspace.take(y.shape);
  if (block.resample == Resample::up) {
    (*block.straight)(x, sum, workspace);
    end.residual = &sum;
    block.convolution2(y, sum, workspace, end);
    nn::upsample_bilinear_2x(sum, out);
  } else {
    block.convolution2(y, sum, workspace, end);
    nn::average_pool(sum, out, true);
    const nn::TensorView half = workspace.take(nn::half_size(x.shape));
    nn::average_pool(x, half, true);
    straight.residual = &out;
    (*block.straight)(half, out, workspace, straight);
  }
}

void Refiner::forward_one(const nn::TensorView& input, const float* noise,
                          const nn::TensorView& output, nn::Workspace& workspace) const {
  const nn::Workspace::Scope scope(workspace);
  std::array<std::size_t, 2> sizes = {};
  nn::Shape shape = input.shape;
  for (std::size_t i = 0; i + 1 < blocks_.size(); ++i) {
    shape = blocks_[i].output(shape);
    sizes[i % 2] =
        std::max(sizes[i % 2], shape.pixels() * static_cast<std::size_t>(shape.channels));
  }
  const std::array<float*, 2> buffers = {workspace.take(sizes[0]), workspace.take(sizes[1])};
  const nn::TensorView image = input.channels(0, kImageChannels);
  nn::TensorView x = input;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const bool last = i + 1 == blocks_.size();
    shape = blocks_[i].output(x.shape);
    const nn::TensorView out =
        last ? output
             : nn::TensorView{buffers[i % 2], shape, static_cast<std::size_t>(shape.channels)};
    const bool in_sum = last && output_ == Output::tanh_of_sum;
    run(blocks_[i], x, noise, in_sum ? &image : nullptr, out, workspace);
    noise += blocks_[i].noise();
    x = out;
  }
  nn::tanh(output, output);
  if (output_ == Output::tanh_of_net) nn::add(output, image, output);
}

void Refiner::forward(const nn::TensorView& input, const float* noise, const nn::TensorView& output,
                      nn::Workspace& workspace) const {
  check_image(kName, input, kImageChannels + 1, kMultiple);
  nn::Shape shape = input.shape;
  shape.channels = kImageChannels;
  check_shape(kName, "output", output, shape);
  for (int i = 0; i < input.shape.images; ++i) {
    forward_one(input.images(i, 1), noise + static_cast<std::size_t>(i) * noise_count(),
                output.images(i, 1), workspace);
  }
}

}  // namespace ps::models
