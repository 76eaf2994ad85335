// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/lpips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/models/layers.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/resample.h"

namespace ps::models {
namespace {

constexpr char kName[] = "Lpips";
constexpr nn::MaxPool kPool = {3, 2, 0, true};
constexpr std::array<double, 3> kShift = {-.030, -.088, -.188};
constexpr std::array<double, 3> kScale = {.458, .448, .450};
constexpr float kEps = 1e-10f;

/// (image - shift) / scale
void scale_image(const nn::TensorView& image, const nn::TensorView& out) {
  std::array<float, 3> scale, shift;
  for (std::size_t c = 0; c < 3; ++c) {
    scale[c] = static_cast<float>(1 / kScale[c]);
    shift[c] = static_cast<float>(-kShift[c] / kScale[c]);
  }
  nn::scale_shift(image, scale.data(), shift.data(), out);
}

float length(const float* x, int channels) {
  float sum = 0;
  for (int c = 0; c < channels; ++c) sum += x[c] * x[c];
  return std::sqrt(sum) + kEps;
}

float difference(const float* a, const float* b, const std::vector<float>& weights) {
  const int channels = static_cast<int>(weights.size());
  const float of_a = 1 / length(a, channels), of_b = 1 / length(b, channels);
  float sum = 0;
  for (int c = 0; c < channels; ++c) {
    const float d = a[c] * of_a - b[c] * of_b;
    sum += weights[static_cast<std::size_t>(c)] * d * d;
  }
  return sum;
}

/// Adds to each distance the mean over an image's pixels. The second half of x's images is b's.
void compare(const nn::TensorView& x, const std::vector<float>& weights, float* distances,
             nn::Workspace& workspace) {
  const nn::Workspace::Scope scope(workspace);
  const int images = x.shape.images / 2;
  const nn::TensorView a = x.images(0, images), b = x.images(images, images);
  const std::size_t pixels = a.shape.pixels(), each = pixels / static_cast<std::size_t>(images);
  float* const differences = workspace.take(pixels);
  parallel_chunks(pixels, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      differences[i] = difference(a.pixel(i), b.pixel(i), weights);
    }
  });
  for (int n = 0; n < images; ++n) {
    const float* from = differences + static_cast<std::size_t>(n) * each;
    double sum = 0;
    for (std::size_t i = 0; i < each; ++i) sum += from[i];
    distances[n] += static_cast<float>(sum / static_cast<double>(each));
  }
}

void check_images(const nn::TensorView& images) {
  check_image(kName, images, 3, 1);
  if (images.shape.height < Lpips::kSmallest || images.shape.width < Lpips::kSmallest) {
    throw Error(kName, "the images are too small",
                "sides of at least " + std::to_string(Lpips::kSmallest) + " pixels");
  }
}

std::vector<float> read_weights(const Layers& layers, int index, int channels) {
  return layers.weight("lin" + std::to_string(index) + ".model.1", {1, channels, 1, 1}).values;
}

}  // namespace

std::vector<Lpips::Fire> Lpips::read_fires(const Layers& layers, int in) {
  struct Place {
    int index;
    bool pooled;
    int compared;  ///< as which layer; 0 = not
  };
  constexpr Place kPlaces[] = {{3, true, 0}, {4, false, 1},  {6, true, 0},   {7, false, 2},
                               {9, true, 3}, {10, false, 4}, {11, false, 5}, {12, false, 6}};
  std::vector<Fire> fires;
  for (const Place& place : kPlaces) {
    const std::string name = "net." + std::to_string(place.index) + ".";
    ConvolutionSpec spec;
    spec.kernel = 1;
    spec.in = in;
    nn::Convolution squeeze = layers.convolution(name + "squeeze", spec);
    spec.in = squeeze.out_channels();
    nn::Convolution expand1 = layers.convolution(name + "expand1x1", spec);
    spec.kernel = 3;
    spec.padding = 1;
    nn::Convolution expand3 = layers.convolution(name + "expand3x3", spec);
    in = expand1.out_channels() + expand3.out_channels();
    fires.push_back({std::move(squeeze), std::move(expand1), std::move(expand3), place.pooled, {}});
    if (place.compared > 0) fires.back().weights = read_weights(layers, place.compared, in);
  }
  return fires;
}

Lpips::Lpips(const nn::Weights& weights, const ModelOptions& options)
    : Lpips(Layers(weights, "", options)) {}

Lpips::Lpips(const Layers& layers)
    : first_([&] {
        ConvolutionSpec spec;
        spec.in = 3;
        spec.stride = 2;
        return layers.convolution("net.0", spec);
      }()),
      first_weights_(read_weights(layers, 0, first_.out_channels())),
      fires_(read_fires(layers, first_.out_channels())) {}

/// @return the first layer's output, taken from the workspace
nn::TensorView Lpips::first(const nn::TensorView& scaled, nn::Workspace& workspace) const {
  const nn::TensorView out = workspace.take(first_.output(scaled.shape));
  first_(scaled, out, workspace, activated(nn::kRelu));
  return out;
}

/// @return the block's output, taken from the workspace
nn::TensorView Lpips::run(const Fire& fire, nn::TensorView x, nn::Workspace& workspace) {
  const nn::Shape in = fire.pooled ? nn::pooled_size(x.shape, kPool) : x.shape;
  nn::Shape shape = in;
  const int one = fire.expand1.out_channels(), three = fire.expand3.out_channels();
  shape.channels = one + three;
  const nn::TensorView out = workspace.take(shape);
  const nn::Workspace::Scope scope(workspace);
  if (fire.pooled) {
    const nn::TensorView pooled = workspace.take(in);
    nn::max_pool(x, pooled, kPool);
    x = pooled;
  }
  const nn::TensorView squeezed = workspace.take(fire.squeeze.output(in));
  const nn::Epilogue relu = activated(nn::kRelu);
  fire.squeeze(x, squeezed, workspace, relu);
  fire.expand1(squeezed, out.channels(0, one), workspace, relu);
  fire.expand3(squeezed, out.channels(one, three), workspace, relu);
  return out;
}

void Lpips::distance(const nn::TensorView& a, const nn::TensorView& b, float* distances,
                     nn::Workspace& workspace) const {
  check_images(a);
  check_shape(kName, "the second image", b, a.shape);
  const int images = a.shape.images;
  const nn::Workspace::Scope scope(workspace);
  const nn::TensorView both =
      workspace.take({2 * images, a.shape.height, a.shape.width, a.shape.channels});
  scale_image(a, both.images(0, images));
  scale_image(b, both.images(images, images));
  nn::TensorView x = first(both, workspace);
  std::fill(distances, distances + images, 0.f);
  compare(x, first_weights_, distances, workspace);
  for (const Fire& fire : fires_) {
    x = run(fire, x, workspace);
    if (!fire.weights.empty()) compare(x, fire.weights, distances, workspace);
  }
}

int Lpips::feature_count() const {
  return fires_.back().expand1.out_channels() + fires_.back().expand3.out_channels();
}

void Lpips::features(const nn::TensorView& images, float* features,
                     nn::Workspace& workspace) const {
  check_images(images);
  const nn::Workspace::Scope scope(workspace);
  const nn::TensorView scaled = workspace.take(images.shape);
  scale_image(images, scaled);
  nn::TensorView x = first(scaled, workspace);
  for (const Fire& fire : fires_) x = run(fire, x, workspace);
  const auto count = static_cast<std::size_t>(x.shape.channels);
  const std::size_t each = x.shape.pixels() / static_cast<std::size_t>(x.shape.images);
  for (std::size_t i = 0; i < static_cast<std::size_t>(x.shape.images) * count; ++i) {
    const float* from = x.pixel(i / count * each) + i % count;
    double sum = 0;
    for (std::size_t p = 0; p < each; ++p) sum += from[p * x.stride];
    features[i] = static_cast<float>(sum / static_cast<double>(each));
  }
}

}  // namespace ps::models
