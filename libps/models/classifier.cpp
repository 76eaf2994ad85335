// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/classifier.h"

#include <array>
#include <string>

#include "libps/models/layers.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/resample.h"

namespace ps::models {
namespace {

constexpr char kName[] = "Classifier";
constexpr nn::MaxPool kPool = {3, 2, 1, false};
constexpr std::array<double, 3> kMean = {0.485, 0.456, 0.406};
constexpr std::array<double, 3> kDeviation = {0.229, 0.224, 0.225};

ConvolutionSpec spec_of(int in, int out, int kernel, int stride) {
  ConvolutionSpec spec;
  spec.in = in;
  spec.out = out;
  spec.kernel = kernel;
  spec.stride = stride;
  spec.padding = kernel / 2;
  spec.bias = false;
  return spec;
}

}  // namespace

std::vector<Classifier::Block> Classifier::read_blocks(const Layers& layers, int in) {
  std::vector<Block> blocks;
  for (int stage = 1; stage <= 4; ++stage) {
    for (int i = 0; i < 2; ++i) {
      const std::string name = "layer" + std::to_string(stage) + "." + std::to_string(i) + ".";
      const int stride = stage > 1 && i == 0 ? 2 : 1;
      nn::Convolution first =
          layers.convolution(name + "conv1", spec_of(in, 0, 3, stride), name + "bn1");
      const int out = first.out_channels();
      nn::Convolution second =
          layers.convolution(name + "conv2", spec_of(out, out, 3, 1), name + "bn2");
      Block block = {std::move(first), std::move(second), {}};
      if (stride > 1 || in != out) {
        block.straight.push_back(layers.convolution(
            name + "downsample.0", spec_of(in, out, 1, stride), name + "downsample.1"));
      }
      blocks.push_back(std::move(block));
      in = out;
    }
  }
  return blocks;
}

Classifier::Classifier(const nn::Weights& weights, const ModelOptions& options)
    : Classifier(Layers(weights, weights.has_prefix("classifier.") ? "classifier." : "", options)) {
}

Classifier::Classifier(const Layers& layers)
    : first_(layers.convolution("conv1", spec_of(3, 0, 7, 2), "bn1")),
      blocks_(read_blocks(layers, first_.out_channels())),
      last_(layers.linear("fc", blocks_.back().convolution2.out_channels(), 0)) {}

void Classifier::normalise(const nn::TensorView& image, const nn::TensorView& out) {
  check_image(kName, image, 3, 1);
  std::array<float, 3> scale, shift;
  for (std::size_t c = 0; c < 3; ++c) {
    scale[c] = static_cast<float>(0.5 / kDeviation[c]);
    shift[c] = static_cast<float>((0.5 - kMean[c]) / kDeviation[c]);
  }
  nn::scale_shift(image, scale.data(), shift.data(), out);
}

void Classifier::run(const Block& block, const nn::TensorView& x, const nn::TensorView& out,
                     nn::Workspace& workspace) {
  const nn::Workspace::Scope scope(workspace);
  const nn::TensorView inner = workspace.take(block.convolution1.output(x.shape));
  block.convolution1(x, inner, workspace, activated(nn::kRelu));
  nn::Epilogue end = activated(nn::kRelu);
  end.residual = &x;
  if (!block.straight.empty()) {
    block.straight[0](x, out, workspace);
    end.residual = &out;
  }
  block.convolution2(inner, out, workspace, end);
}

void Classifier::forward(const nn::TensorView& input, const nn::TensorView& logits,
                         nn::Workspace& workspace) const {
  check_image(kName, input, 3, 1);
  check_shape(kName, "logits", logits, {input.shape.images, 1, 1, classes()});
  const nn::Workspace::Scope scope(workspace);
  const nn::TensorView large = workspace.take(first_.output(input.shape));
  first_(input, large, workspace, activated(nn::kRelu));
  nn::TensorView x = workspace.take(nn::pooled_size(large.shape, kPool));
  nn::max_pool(large, x, kPool);
  for (const Block& block : blocks_) {
    const nn::TensorView out =
        workspace.take(block.convolution2.output(block.convolution1.output(x.shape)));
    run(block, x, out, workspace);
    x = out;
  }
  const nn::TensorView mean = workspace.take({input.shape.images, 1, 1, x.shape.channels});
  nn::global_average(x, mean);
  last_(mean, logits);
}

}  // namespace ps::models
