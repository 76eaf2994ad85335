// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/linear.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

using reference::Values;

void expect_reference(unsigned seed, Storage storage) {
  Random random(seed);
  for (int i = 0; i < 150; ++i) {
    const Slice in(random.shape(), random.pick({0, 0, 5}), random);
    const int channels = in.shape().channels,
              outs = random.channels() * (random.integer(0, 20) > 0);
    const WeightTensor weight = random.weights({outs, channels});
    std::vector<float> bias;
    if (random.coin()) bias = random.reals(weight.shape[0]);
    const Values sum = reference::linear(
        Values(in), storage == Storage::bf16 ? rounded_to_bf16(weight) : weight, bias);
    const Slice out(sum.shape, random.pick({0, 0, 3}));
    const RandomEpilogue epilogue(random, out, random.pick({0, 2}));
    const Values expected = epilogue.applied(sum);
    on_every_isa([&] {
      const Linear linear(weight, bias, storage);
      epilogue.prepare(out);
      linear(in, out, epilogue.epilogue());
      EXPECT_TRUE(near(out, expected, 1e-6)) << "from " << text(in.shape());
      EXPECT_TRUE(out.margins_untouched());
    });
  }
}

TEST(Linear, is_its_reference) { expect_reference(91, Storage::f32); }

TEST(Linear, with_bf16_weights_is_the_reference_with_those_weights) {
  expect_reference(92, Storage::bf16);
}

TEST(Linear, of_a_row_does_not_depend_on_how_many_there_are) {
  Random random(93);
  const WeightTensor weight = random.weights({97, 81});
  const std::vector<float> bias = random.reals(97);
  const Slice in({1, 1, 50, 81}, 0, random);
  on_every_isa([&] {
    const Linear linear(weight, bias);
    const Tensor alone({1, 1, 50, 97});
    for (int row = 0; row < 50; ++row) {
      linear({in.view().pixel(0, 0, row), {1, 1, 1, 81}, 81},
             {alone.view().pixel(0, 0, row), {1, 1, 1, 97}, 97});
    }
    for (int count = 1; count <= 50; ++count) {
      const Tensor together({1, 1, count, 97});
      linear({in.view().data, {1, 1, count, 81}, 81}, together);
      EXPECT_TRUE(same_bytes(together, {alone.data(), {1, 1, count, 97}, 97})) << count << " rows";
    }
  });
}

TEST(Linear, refuses_misfit_shapes) {
  Random random(94);
  EXPECT_THROW(Linear(random.weights({3, 2, 1}), {}), Error);
  EXPECT_THROW(Linear(random.weights({3, 2}), {1}), Error);
  const Linear linear(random.weights({3, 2}), {});
  const Tensor in({1, 4, 5, 2}), out({1, 4, 5, 3}), small({1, 4, 4, 3});
  EXPECT_NO_THROW(linear(in, out));
  EXPECT_THROW(linear(out, out), Error);
  EXPECT_THROW(linear(in, small), Error);
}

}  // namespace
}  // namespace ps::nn
