// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/softmax.h"

#include <algorithm>
#include <limits>
#include <string>

#include "libps/core/error.h"
#include "libps/nn/indirect_product.h"
#include "libps/nn/kernels/kernels.h"
#include "libps/nn/pixel_loop.h"

namespace ps::nn {
namespace {

constexpr int kLanes = 8;  ///< of sums: as many chains, so that a sum's latency is hidden

void softmax_of_pixel(const float* in, float* out, int channels, float temperature) {
  float most = -std::numeric_limits<float>::infinity();
  for (int c = 0; c < channels; ++c) most = std::max(most, in[c]);
  for (int c = 0; c < channels; ++c) out[c] = (in[c] - most) / temperature;
  kernels().exp(out, out, static_cast<std::size_t>(channels));
  float sums[kLanes] = {};
  for (int c = 0; c < channels; ++c) sums[c % kLanes] += out[c];
  double sum = 0;
  for (const float s : sums) sum += s;
  const auto inverse = static_cast<float>(1 / sum);
  for (int c = 0; c < channels; ++c) out[c] *= inverse;
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
