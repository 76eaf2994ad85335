// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/masked_convolution.h"

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
    const WeightTensor weight = random.weights({outs, channels, 3, 3});
    std::vector<float> bias;
    if (random.coin()) bias = random.reals(weight.shape[0]);
    std::vector<std::uint8_t> mask(9 *
                                   static_cast<std::size_t>(in.shape().height * in.shape().width));
    for (std::uint8_t& visible : mask)
      visible = static_cast<std::uint8_t>(random.pick({0, 0, 1, 255}));
    const int dilation = random.integer(1, 3);
    const Values sum = reference::masked_convolution(
        Values(in), mask, storage == Storage::bf16 ? rounded_to_bf16(weight) : weight, bias,
        dilation);
    const Slice out(sum.shape, random.pick({0, 0, 3}));
    const RandomEpilogue epilogue(random, out, random.pick({0, 2}));
    const Values expected = epilogue.applied(sum);
    on_every_isa([&] {
      const MaskedConvolution convolution(weight, bias, dilation, storage);
      epilogue.prepare(out);
      convolution(in, mask.data(), out, epilogue.epilogue());
      EXPECT_TRUE(near(out, expected, 2e-6)) << "from " << text(in.shape());
      EXPECT_TRUE(out.margins_untouched());
    });
  }
}

TEST(MaskedConvolution, is_its_reference) { expect_reference(81, Storage::f32); }

TEST(MaskedConvolution, with_bf16_weights_is_the_reference_with_those_weights) {
  expect_reference(82, Storage::bf16);
}

TEST(MaskedConvolution, does_not_see_what_is_hidden) {
  Random random(83);
  const MaskedConvolution convolution(random.weights({5, 4, 3, 3}), random.reals(5));
  std::vector<std::uint8_t> mask(9 * 20, 0);
  const Slice in({1, 4, 5, 4}, 0, random);
  std::fill_n(in.view().data, 80, std::nanf(""));
  const Tensor out({1, 4, 5, 5});
  convolution(in, mask.data(), out);
  for (std::size_t p = 0; p < 20; ++p) {
    for (std::size_t c = 0; c < 5; ++c) EXPECT_EQ(out.view().pixel(p)[c], convolution.bias()[c]);
  }
}

TEST(MaskedConvolution, of_a_pixel_does_not_depend_on_the_rest_of_the_batch) {
  Random random(85);
  const WeightTensor weight = random.weights({33, 20, 3, 3});
  const Slice in({7, 5, 6, 20}, 0, random);
  std::vector<std::uint8_t> mask(9 * 30);
  for (std::uint8_t& visible : mask) visible = random.coin();
  on_every_isa([&] {
    const MaskedConvolution convolution(weight, random.reals(33));
    const Tensor all({7, 5, 6, 33}), one({1, 5, 6, 33});
    convolution(in, mask.data(), all);
    for (int image = 0; image < 7; ++image) {
      convolution(in.view().images(image, 1), mask.data(), one);
      EXPECT_TRUE(same_bytes(one, all.view().images(image, 1)));
    }
  });
}

TEST(MaskedConvolution, refuses_misfit_shapes) {
  Random random(84);
  EXPECT_THROW(MaskedConvolution(random.weights({3, 2, 5, 5}), {}), Error);
  EXPECT_THROW(MaskedConvolution(random.weights({3, 2, 3, 3}), {1}), Error);
  EXPECT_THROW(MaskedConvolution(random.weights({3, 2, 3, 3}), {}, 0), Error);
  const MaskedConvolution convolution(random.weights({3, 2, 3, 3}), {});
  const std::vector<std::uint8_t> mask(9 * 20, 1);
  const Tensor in({1, 4, 5, 2}), out({1, 4, 5, 3}), small({1, 4, 4, 3});
  EXPECT_NO_THROW(convolution(in, mask.data(), out));
  EXPECT_THROW(convolution(out, mask.data(), out), Error);
  EXPECT_THROW(convolution(in, mask.data(), small), Error);
}

}  // namespace
}  // namespace ps::nn
