// SPDX-License-Identifier: BSD-3-Clause
#include <dnnl.hpp>

#include "tests/bench/nn/peers.h"

namespace ps::bench {
namespace {

void fill(dnnl::memory& memory) {
  auto* values = static_cast<float*>(memory.get_data_handle());
  for (std::size_t i = 0; i < memory.get_desc().get_size() / sizeof(float); ++i) {
    values[i] = static_cast<float>(i % 17) * 0.01f;
  }
}

}  // namespace

/// In the layouts that oneDNN likes best, weights reordered beforehand, its own choice of
/// algorithm.
double time_onednn(const ConvolutionCase& c) {
  using dnnl::memory;
  const dnnl::engine engine(dnnl::engine::kind::cpu, 0);
  dnnl::stream stream(engine);
  const auto any = memory::format_tag::any;
  const auto f32 = memory::data_type::f32;
  const memory::desc in({1, c.in, c.side, c.side}, f32, any);
  const memory::desc weights({c.out, c.in, c.kernel, c.kernel}, f32, any);
  const memory::desc bias({c.out}, f32, memory::format_tag::a);
  const memory::desc out({1, c.out, c.output(), c.output()}, f32, any);
  const dnnl::convolution_forward::desc wanted(
      dnnl::prop_kind::forward_inference, dnnl::algorithm::convolution_auto, in, weights, bias, out,
      {c.stride, c.stride}, {c.padding, c.padding}, {c.padding, c.padding});
  const dnnl::convolution_forward::primitive_desc chosen(wanted, engine);
  memory a(chosen.src_desc(), engine), w(chosen.weights_desc(), engine), b(bias, engine),
      r(chosen.dst_desc(), engine);
  fill(a);
  fill(w);
  fill(b);
  const dnnl::convolution_forward convolution(chosen);
  return fastest(9, [&] {
    convolution.execute(
        stream, {{DNNL_ARG_SRC, a}, {DNNL_ARG_WEIGHTS, w}, {DNNL_ARG_BIAS, b}, {DNNL_ARG_DST, r}});
    stream.wait();
  });
}

}  // namespace ps::bench
