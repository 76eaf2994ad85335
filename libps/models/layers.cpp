// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/layers.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "libps/core/error.h"

namespace ps::models {
namespace {

std::string to_text(const nn::Shape& shape) {
  return nn::to_string(
      {static_cast<std::size_t>(shape.images), static_cast<std::size_t>(shape.height),
       static_cast<std::size_t>(shape.width), static_cast<std::size_t>(shape.channels)});
}

/// weight and bias of `norm(convolution)`; exact, since the norm comes after the padding.
void fold(const nn::ScaleShift& norm, nn::WeightTensor& weight, std::vector<float>& bias) {
  const std::size_t outputs = norm.scale.size(), each = weight.values.size() / outputs;
  bias.resize(outputs);
  for (std::size_t o = 0; o < outputs; ++o) {
    for (std::size_t i = 0; i < each; ++i) weight.values[o * each + i] *= norm.scale[o];
    bias[o] = bias[o] * norm.scale[o] + norm.shift[o];
  }
}

}  // namespace

nn::WeightTensor Layers::weight(const std::string& name, const std::vector<int>& shape) const {
  return weights_.layer(prefix_ + name, {shape.begin(), shape.end()});
}

nn::WeightTensor Layers::tensor(const std::string& name, const std::vector<int>& shape) const {
  return weights_.get(prefix_ + name, {shape.begin(), shape.end()});
}

std::vector<float> Layers::vector(const std::string& name, int count) const {
  return weights_.vector(prefix_ + name, static_cast<std::size_t>(count));
}

std::vector<float> Layers::variance(const std::string& name, int count) const {
  return weights_.variance(prefix_ + name, static_cast<std::size_t>(count));
}

nn::Convolution Layers::convolution(const std::string& name, const ConvolutionSpec& spec,
                                    const std::string& norm,
                                    const std::vector<float>& added) const {
  nn::WeightTensor w = weight(name, {spec.out, spec.in, spec.kernel, spec.kernel});
  const std::size_t out = w.shape[0];
  std::vector<float> bias;
  if (spec.bias) bias = weights_.vector(prefix_ + name + ".bias", out);
  if (!added.empty()) {
    bias.resize(out);
    std::transform(bias.begin(), bias.end(), added.begin(), bias.begin(), std::plus<>());
  }
  if (!norm.empty()) fold(nn::batch_norm(weights_, prefix_ + norm, out), w, bias);
  nn::ConvolutionOptions options;
  options.stride = spec.stride;
  options.padding = spec.padding;
  options.method = options_.method;
  options.storage = options_.storage;
  return {w, std::move(bias), options};
}

nn::TransposedConvolution Layers::transposed(const std::string& name, int in, int out) const {
  const nn::WeightTensor w = weight(name, {in, out, 4, 4});
  return {w, weights_.vector(prefix_ + name + ".bias", w.shape[1]), options_.storage};
}

nn::Linear Layers::linear(const std::string& name, int in, int out) const {
  const nn::WeightTensor w = weight(name, {out, in});
  return {w, weights_.vector(prefix_ + name + ".bias", w.shape[0]), options_.storage};
}

nn::Epilogue activated(nn::Activation activation) {
  nn::Epilogue epilogue;
  epilogue.activation = activation;
  return epilogue;
}

void check_shape(const char* network, const char* tensor, const nn::TensorView& view,
                 const nn::Shape& expected) {
  if (view.shape == expected) return;
  throw Error(network, std::string(tensor) + " has the shape " + to_text(view.shape),
              to_text(expected) + " (images, height, width, channels)");
}

void check_image(const char* network, const nn::TensorView& view, int channels, int multiple) {
  const nn::Shape& s = view.shape;
  if (s.images > 0 && s.height > 0 && s.width > 0 && s.height % multiple == 0 &&
      s.width % multiple == 0 && s.channels == channels) {
    return;
  }
  throw Error(network,
              "the input has the shape " + to_text(s) + " (images, height, width, channels)",
              std::to_string(channels) + " channels" +
                  (multiple > 1 ? " and sides that are multiples of " + std::to_string(multiple)
                                : " and at least one pixel"));
}

}  // namespace ps::models
