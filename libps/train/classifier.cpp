// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/classifier.h"

#include <string>

#include "libps/train/layers.h"

namespace ps::train {
namespace {

constexpr int kStages = 4, kBlocks = 2;

std::string block_name(int stage, int block) {
  return "layer" + std::to_string(stage) + "." + std::to_string(block) + ".";
}

int stride_of(int stage, int block) { return stage > 1 && block == 0 ? 2 : 1; }

void add_normed_convolution(Parameters& p, const std::string& name, const std::string& norm, int in,
                            int out, int kernel) {
  add_convolution(p, name, in, out, kernel, 1, false);
  add_batch_norm(p, norm, out);
}

}  // namespace

Classifier::Classifier(int width, int classes, std::uint64_t seed)
    : parameters("classifier.", seed) {
  add_normed_convolution(parameters, "conv1", "bn1", 3, width, 7);
  int in = width;
  for (int stage = 1; stage <= kStages; ++stage) {
    const int out = width << (stage - 1);
    for (int i = 0; i < kBlocks; ++i, in = out) {
      const std::string name = block_name(stage, i);
      add_normed_convolution(parameters, name + "conv1", name + "bn1", in, out, 3);
      add_normed_convolution(parameters, name + "conv2", name + "bn2", out, out, 3);
      if (in == out) continue;
      add_normed_convolution(parameters, name + "downsample.0", name + "downsample.1", in, out, 1);
    }
  }
  parameters.normal("fc.weight", {classes, in}, .05);
  parameters.constant("fc.bias", {classes}, 0);
}

Tensor Classifier::block(const std::string& name, const Tensor& x, int stride,
                         bool training) const {
  const Parameters& p = parameters;
  Tensor y = convolution(p, name + "conv1", x, stride, 1);
  y = torch::relu(batch_norm(p, name + "bn1", y, training));
  y = batch_norm(p, name + "bn2", convolution(p, name + "conv2", y, 1, 1), training);
  if (p.trained().count(name + "downsample.0.weight") == 0) return torch::relu(y + x);
  // Every other pixel, then a stride of 1: oneDNN 2.6 writes past its memory in a strided 1x1
  // convolution of 2 channels.
  using torch::indexing::Slice;
  const Slice some(torch::indexing::None, torch::indexing::None, stride);
  const Tensor straight =
      convolution(p, name + "downsample.0", x.index({Slice(), Slice(), some, some}), 1, 0);
  return torch::relu(y + batch_norm(p, name + "downsample.1", straight, training));
}

Tensor Classifier::forward(const Tensor& image, bool training) const {
  const auto by_channel = [&](float r, float g, float b) {
    return torch::tensor({r, g, b}, image.options()).view({1, 3, 1, 1});
  };
  Tensor x = ((image + 1) / 2 - by_channel(.485f, .456f, .406f)) / by_channel(.229f, .224f, .225f);
  x = batch_norm(parameters, "bn1", convolution(parameters, "conv1", x, 2, 3), training);
  x = torch::max_pool2d(torch::relu(x), 3, 2, 1);
  for (int stage = 1; stage <= kStages; ++stage) {
    for (int i = 0; i < kBlocks; ++i) {
      x = block(block_name(stage, i), x, stride_of(stage, i), training);
    }
  }
  return torch::linear(x.mean({2, 3}), parameters["fc.weight"], parameters["fc.bias"]);
}

}  // namespace ps::train
