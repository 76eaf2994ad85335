// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/softmax.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string>

#include "libps/core/error.h"
#include "libps/nn/indirect_product.h"
#include "libps/nn/kernels/kernels.h"
#include "libps/nn/pixel_loop.h"

namespace ps::nn {
namespace {

void softmax_of_pixel(const float* in, float* out, int channels, float temperature) {
  const auto larger = [](float a, float b) { return b > a ? b : a; };
  const float most = folded(in, channels, -std::numeric_limits<float>::infinity(), larger, larger);
  if (in != out) std::copy_n(in, channels, out);  // a loop over one array alone is vectorised
  for (int c = 0; c < channels; ++c) out[c] = (out[c] - most) / temperature;
  kernels().exp(out, out, static_cast<std::size_t>(channels));
  const float sum = folded(out, channels, 0.0f, std::plus<>(), std::plus<>());
  for (int c = 0; c < channels; ++c) out[c] /= sum;
}

}  // namespace

void softmax(const TensorView& in, const TensorView& out, float temperature) {
  check_same(out.shape, in.shape, "softmax");
  if (!(temperature > 0)) {
    throw Error("softmax", "the temperature is " + std::to_string(temperature), "more than 0");
  }
  const int channels = in.shape.channels;
  for_ranges(in.shape.pixels(), static_cast<std::size_t>(channels),
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i) {
                 softmax_of_pixel(in.pixel(i), out.pixel(i), channels, temperature);
               }
             });
}

}  // namespace ps::nn
