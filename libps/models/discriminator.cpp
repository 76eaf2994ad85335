// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/discriminator.h"

#include <algorithm>
#include <string>

#include "libps/models/layers.h"
#include "libps/nn/norm.h"
#include "libps/nn/resample.h"

namespace ps::models {
namespace {

constexpr char kName[] = "Discriminator";

/// @return the mean over an image's pixels of max(0, 1 + D)
double hinge(const nn::TensorView& logits, int image) {
  const nn::TensorView one = logits.images(image, 1);
  double sum = 0;
  for (std::size_t i = 0; i < one.shape.pixels(); ++i) sum += std::max(0.f, 1 + *one.pixel(i));
  return sum / static_cast<double>(one.shape.pixels());
}

}  // namespace

Discriminator::Scale Discriminator::read_scale(const Layers& layers, const std::string& prefix) {
  Scale scale;
  ConvolutionSpec spec;
  spec.in = 3;
  spec.kernel = 4;
  spec.padding = 2;
  for (std::size_t i = 0; i < kLayers; ++i) {
    const bool first = i == 0, last = i + 1 == kLayers;
    spec.stride = i < 3 ? 2 : 1;
    spec.bias = first || last;
    spec.out = last ? 1 : 0;
    const std::string name = prefix + ".model" + std::to_string(i) + (spec.bias ? ".0" : ".0.0");
    scale.push_back(layers.convolution(name, spec));
    spec.in = scale.back().out_channels();
  }
  return scale;
}

Discriminator::Discriminator(const nn::Weights& weights, const ModelOptions& options) {
  const Layers layers(weights, "netD.", options);
  for (std::size_t s = 0; s < kScales; ++s) {
    scales_[s] = read_scale(layers, "discriminator_" + std::to_string(s));
  }
}

Discriminator::Shapes Discriminator::shapes(const nn::Shape& image) const {
  Shapes shapes;
  nn::Shape scaled = image;
  for (std::size_t s = 0; s < kScales; ++s, scaled = nn::half_size(scaled)) {
    for (std::size_t l = 0; l < kLayers; ++l) {
      shapes[s][l] = scales_[s][l].output(l == 0 ? scaled : shapes[s][l - 1]);
    }
  }
  return shapes;
}

void Discriminator::run(const Scale& scale, const nn::TensorView& image,
                        const std::array<nn::TensorView, kLayers>& maps, nn::Workspace& workspace) {
  const nn::Workspace::Scope scope(workspace);
  nn::TensorView x = image;
  for (std::size_t l = 0; l < kLayers; ++l) {
    const nn::Shape shape = scale[l].output(x.shape);
    nn::TensorView out = maps[l];
    if (out.data == nullptr) {
      out = workspace.take(shape);
    } else {
      check_shape(kName, "a map", out, shape);
    }
    scale[l](x, out, workspace, l == 0 ? activated(nn::kLeakyRelu) : nn::Epilogue{});
    if (l > 0 && l + 1 < kLayers) nn::instance_norm(out, out, nn::kLeakyRelu);
    x = out;
  }
}

void Discriminator::forward(const nn::TensorView& image, const Maps& maps,
                            nn::Workspace& workspace) const {
  check_image(kName, image, scales_[0][0].in_channels(), 1);
  const nn::Workspace::Scope scope(workspace);
  run(scales_[0], image, maps[0], workspace);
  const nn::TensorView half = workspace.take(nn::half_size(image.shape));
  nn::average_pool(image, half, false);
  run(scales_[1], half, maps[1], workspace);
}

void Discriminator::score(const nn::TensorView& image, float* scores,
                          nn::Workspace& workspace) const {
  const nn::Workspace::Scope scope(workspace);
  const Shapes all = shapes(image.shape);
  Maps maps;
  for (std::size_t s = 0; s < kScales; ++s) maps[s].back() = workspace.take(all[s].back());
  forward(image, maps, workspace);
  for (int i = 0; i < image.shape.images; ++i) {
    double sum = 0;
    for (const auto& scale : maps) sum += hinge(scale.back(), i);
    scores[i] = static_cast<float>(sum / kScales);
  }
}

}  // namespace ps::models
