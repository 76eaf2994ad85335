// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/elementwise.h"

#include "libps/nn/indirect_product.h"
#include "libps/nn/kernels/kernels.h"
#include "libps/nn/pixel_loop.h"

namespace ps::nn {
namespace {

template <class Kernel>
void map(const char* where, const Kernel& kernel, const TensorView& in, const TensorView& out) {
  check_same(out.shape, in.shape, where);
  for_runs(kernel, in, out);
}

}  // namespace

void activate(const TensorView& in, const TensorView& out, Activation activation) {
  const auto kernel = kernels().activate;
  const auto run = [&](const float* x, float* y, std::size_t count) {
    kernel(x, y, count, activation.slope);
  };
  map("activate", run, in, out);
}

void elu(const TensorView& in, const TensorView& out) {
  const auto kernel = kernels().elu;
  map(
      "elu", [&](const float* x, float* y, std::size_t count) { kernel(x, y, count, 1); }, in, out);
}

void concat_elu(const TensorView& in, const TensorView& out) {
  Shape twice = in.shape;
  twice.channels *= 2;
  check_same(out.shape, twice, "concatenated elu");
  const auto kernel = kernels().elu;
  const int channels = in.shape.channels;
  const auto run = [&](const float* x, float* plus, float* minus, std::size_t count) {
    kernel(x, plus, count, 1);
    kernel(x, minus, count, -1);
  };
  for_runs(run, in, out.channels(0, channels), out.channels(channels, channels));
}

void tanh(const TensorView& in, const TensorView& out) { map("tanh", kernels().tanh, in, out); }

void sigmoid(const TensorView& in, const TensorView& out) {
  map("sigmoid", kernels().sigmoid, in, out);
}

void scale_shift(const TensorView& in, const float* scale, const float* shift,
                 const TensorView& out, Activation activation) {
  check_same(out.shape, in.shape, "scale and shift");
  const auto kernel = kernels().scale_shift;
  const auto channels = static_cast<std::size_t>(in.shape.channels);
  for_ranges(in.shape.pixels(), channels, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      kernel(in.pixel(i), scale, shift, out.pixel(i), channels, activation.slope);
    }
  });
}

void add(const TensorView& a, const TensorView& b, const TensorView& out, Activation activation) {
  check_same(b.shape, a.shape, "sum");
  check_same(out.shape, a.shape, "sum");
  const auto kernel = kernels().add;
  const auto run = [&](const float* x, const float* y, float* sum, std::size_t count) {
    kernel(x, y, sum, count, activation.slope);
  };
  for_runs(run, a, b, out);
}

void gated_add(const TensorView& base, const TensorView& value, const TensorView& gate,
               const TensorView& out) {
  check_same(value.shape, base.shape, "gated sum");
  check_same(gate.shape, base.shape, "gated sum");
  check_same(out.shape, base.shape, "gated sum");
  for_runs(kernels().gated_add, base, value, gate, out);
}

}  // namespace ps::nn
