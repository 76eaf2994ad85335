// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "libps/core/parallel.h"
#include "libps/nn/codebook.h"
#include "libps/nn/convolution.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/linear.h"
#include "libps/nn/masked_convolution.h"
#include "libps/nn/norm.h"
#include "libps/nn/resample.h"
#include "libps/nn/softmax.h"
#include "libps/nn/transposed_convolution.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

/// Everything with one input, large enough for several ranges of work.
struct Operator {
  const char* name;
  Shape out;
  std::function<void(const TensorView& in, const TensorView& out)> run;
};

constexpr Shape kIn = {2, 47, 43, 40};

Shape with_channels(int channels) { return {kIn.images, kIn.height, kIn.width, channels}; }

std::vector<Operator> operators(Random& random) {
  const std::vector<float> values = random.reals(80);
  const std::vector<std::uint8_t> mask(9 * 47 * 43, 1);
  const WeightTensor kernel = random.weights({24, 40, 3, 3});
  const auto convolution = [&](Method method) {
    return [kernel, method](const TensorView& in, const TensorView& out) {
      Workspace workspace;
      Convolution(kernel, {}, {1, 1, 1, method})(in, out, workspace);
    };
  };
  const Shape twice = {2, 94, 86, 40}, half = {2, 24, 22, 40};
  return {
      {"activate", kIn, [](auto& in, auto& out) { activate(in, out, kRelu); }},
      {"elu", kIn, elu},
      {"concat_elu", with_channels(80), concat_elu},
      {"tanh", kIn, nn::tanh},
      {"sigmoid", kIn, sigmoid},
      {"scale_shift", kIn,
       [values](auto& in, auto& out) { scale_shift(in, values.data(), values.data() + 40, out); }},
      {"add", kIn, [](auto& in, auto& out) { add(in, in, out); }},
      {"gated_add", kIn, [](auto& in, auto& out) { gated_add(in, in, in, out); }},
      {"instance_norm", kIn, [](auto& in, auto& out) { instance_norm(in, out, kLeakyRelu); }},
      {"positional_norm", kIn, positional_norm},
      {"softmax", kIn, [](auto& in, auto& out) { softmax(in, out, 0.7f); }},
      {"upsample", twice, upsample_bilinear_2x},
      {"average_pool", half, [](auto& in, auto& out) { average_pool(in, out, true); }},
      {"max_pool", half,
       [](auto& in, auto& out) {
         max_pool(in, out, {3, 2, 1, false});
       }},
      {"global_average", {2, 1, 1, 40}, global_average},
      {"direct convolution", with_channels(24), convolution(Method::direct)},
      {"winograd convolution", with_channels(24), convolution(Method::winograd)},
      {"linear", with_channels(20),
       [w = random.weights({20, 40})](auto& in, auto& out) { Linear(w, {})(in, out); }},
      {"transposed convolution",
       {2, 94, 86, 8},
       [w = random.weights({40, 8, 4, 4})](auto& in, auto& out) {
         TransposedConvolution(w, {})(in, out);
       }},
      {"masked convolution", with_channels(24),
       [kernel, mask](auto& in, auto& out) {
         MaskedConvolution(kernel, {}, 2)(in, mask.data(), out);
       }},
      {"codebook", with_channels(40), [w = random.weights({40, 64})](auto& in, auto& out) {
         const Codebook codebook(w);
         std::vector<std::int32_t> codes(in.shape.pixels());
         codebook.nearest(in, codes.data());
         codebook.embed(codes.data(), out);
       }}};
}

TEST(Threads, one_two_and_three_give_the_same_bytes) {
  Random random(121);
  const Slice in(kIn, 0, random, -3, 3);
  const std::vector<Operator> all = operators(random);
  on_every_isa([&] {
    for (const Operator& op : all) {
      SCOPED_TRACE(op.name);
      const Tensor one(op.out), more(op.out);
      set_threads(1);
      op.run(in, one);
      EXPECT_GT(reference::Values(one.view()).largest(), 0);
      for (const int threads : {2, 3}) {
        set_threads(threads);
        op.run(in, more);
        EXPECT_TRUE(same_bytes(more, one)) << threads << " threads";
      }
    }
  });
  set_threads(0);
}

}  // namespace
}  // namespace ps::nn
