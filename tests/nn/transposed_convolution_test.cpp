// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/transposed_convolution.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

using reference::Values;

void expect_reference(unsigned seed, Storage storage) {
  Random random(seed);
  for (int i = 0; i < 100; ++i) {
    const Slice in(random.shape(), random.pick({0, 0, 5}), random);
    const int channels = in.shape().channels,
              outs = random.channels() * (random.integer(0, 20) > 0);
    const WeightTensor weight = random.weights({channels, outs, 4, 4});
    std::vector<float> bias;
    if (random.coin()) bias = random.reals(weight.shape[1]);
    const Values sum = reference::transposed_convolution(
        Values(in), storage == Storage::bf16 ? rounded_to_bf16(weight) : weight, bias);
    const Slice out(sum.shape, random.pick({0, 0, 3}));
    const RandomEpilogue epilogue(random, out, random.pick({0, 2}));
    const Values expected = epilogue.applied(sum);
    on_every_isa([&] {
      const TransposedConvolution convolution(weight, bias, storage);
      EXPECT_EQ(convolution.output(in.shape()), sum.shape);
      epilogue.prepare(out);
      convolution(in, out, epilogue.epilogue());
      EXPECT_TRUE(near(out, expected, 2e-6)) << "from " << text(in.shape());
      EXPECT_TRUE(out.margins_untouched());
    });
  }
}

TEST(TransposedConvolution, is_its_reference) { expect_reference(71, Storage::f32); }

TEST(TransposedConvolution, with_bf16_weights_is_the_reference_with_those_weights) {
  expect_reference(72, Storage::bf16);
}

TEST(TransposedConvolution, refuses_misfit_shapes) {
  Random random(73);
  EXPECT_THROW(TransposedConvolution(random.weights({3, 2, 3, 3}), {}), Error);
  EXPECT_THROW(TransposedConvolution(random.weights({3, 2, 4, 4}), {1}), Error);
  const TransposedConvolution convolution(random.weights({3, 2, 4, 4}), {1, 2});
  const Tensor in({1, 4, 5, 3}), out({1, 8, 10, 2}), small({1, 8, 9, 2});
  EXPECT_NO_THROW(convolution(in, out));
  EXPECT_THROW(convolution(out, out), Error);
  EXPECT_THROW(convolution(in, small), Error);
  Epilogue epilogue;
  epilogue.residual = &small.view();
  EXPECT_THROW(convolution(in, out, epilogue), Error);
}

}  // namespace
}  // namespace ps::nn
