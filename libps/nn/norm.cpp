// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/norm.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "libps/nn/indirect_product.h"
#include "libps/nn/kernels/kernels.h"
#include "libps/nn/pixel_loop.h"

namespace ps::nn {
namespace {

constexpr double kEpsilon = 1e-5;

/// Biased variances of up to kChannelBlock channels, in the order of the pixels.
void channel_variances(const TensorView& part, const double* mean, double* variance) {
  const std::size_t pixels = part.shape.pixels();
  const int channels = part.shape.channels;
  double sum[kChannelBlock] = {};
  for (std::size_t i = 0; i < pixels; ++i) {
    const float* x = part.pixel(i);
    for (int c = 0; c < channels; ++c) sum[c] += (x[c] - mean[c]) * (x[c] - mean[c]);
  }
  for (int c = 0; c < channels; ++c) variance[c] = sum[c] / static_cast<double>(pixels);
}

/// Up to kChannelBlock channels of one image.
void normalise_block(const TensorView& in, const TensorView& out, Activation activation) {
  double mean[kChannelBlock], variance[kChannelBlock];
  channel_means(in, mean);
  channel_variances(in, mean, variance);
  float minus_mean[kChannelBlock], scale[kChannelBlock], shift[kChannelBlock];
  for (int c = 0; c < in.shape.channels; ++c) {
    minus_mean[c] = static_cast<float>(-mean[c]);
    const double inverse = 1 / std::sqrt(variance[c] + kEpsilon);
    scale[c] = static_cast<float>(inverse);
    shift[c] = static_cast<float>((-mean[c] - minus_mean[c]) * inverse);  // the mean's rounding
  }
  const Kernels& k = kernels();
  const auto channels = static_cast<std::size_t>(in.shape.channels);
  for (std::size_t i = 0; i < in.shape.pixels(); ++i) {
    k.add(in.pixel(i), minus_mean, out.pixel(i), channels, 1);
    k.scale_shift(out.pixel(i), scale, shift, out.pixel(i), channels, activation.slope);
  }
}

void normalise_pixel(const float* in, float* out, int channels) {
  const auto add = [](double sum, float x) { return sum + x; };
  const double mean = folded(in, channels, 0.0, add, std::plus<>()) / channels;
  const auto add_square = [mean](double sum, float x) { return sum + (x - mean) * (x - mean); };
  const double squares = folded(in, channels, 0.0, add_square, std::plus<>());
  const double scale = 1 / std::sqrt(squares / std::max(1, channels - 1) + kEpsilon);
  for (int c = 0; c < channels; ++c) out[c] = static_cast<float>((in[c] - mean) * scale);
}

}  // namespace

void instance_norm(const TensorView& in, const TensorView& out, Activation activation) {
  check_same(out.shape, in.shape, "instance norm");
  for_channel_blocks(in, [&](const TensorView& part, int image, int first) {
    normalise_block(part, out.images(image, 1).channels(first, part.shape.channels), activation);
  });
}

void positional_norm(const TensorView& in, const TensorView& out) {
  check_same(out.shape, in.shape, "positional norm");
  const int channels = in.shape.channels;
  for_ranges(in.shape.pixels(), static_cast<std::size_t>(channels),
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i) {
                 normalise_pixel(in.pixel(i), out.pixel(i), channels);
               }
             });
}

}  // namespace ps::nn
