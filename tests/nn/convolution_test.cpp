// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/convolution.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

using reference::Values;

// Bounds are of the largest output (or of 1); what was measured is about a third of each.
constexpr double kDirect = 2e-6;
constexpr double kWinograd = 5e-6;

struct Case {
  Case(Random& random, int kernel, const ConvolutionOptions& given)
      : options(given),
        in(random.shape(), random.pick({0, 0, 5}), random),
        weight(random.weights({random.channels() * (random.integer(0, 20) > 0), in.shape().channels,
                               kernel, kernel})) {
    if (random.coin()) bias = random.reals(weight.shape[0]);
    if (random.coin()) {
      scale = random.reals(weight.shape[1], 0.5f, 1.5f);
      shift = random.reals(weight.shape[1]);
      prologue = {scale.data(), shift.data()};
    }
  }

  /// The sum, before an epilogue.
  Values expected() const {
    const WeightTensor used = options.storage == Storage::bf16 ? rounded_to_bf16(weight) : weight;
    Values values(in);
    if (prologue.scale)
      values = reference::activation(reference::scale_shift(values, scale, shift), 0);
    return reference::convolution(values, used, bias,
                                  {options.stride, options.padding, options.dilation});
  }

  ConvolutionOptions options;
  Slice in;
  WeightTensor weight;
  std::vector<float> bias, scale, shift;
  Prologue prologue;
};

void expect_reference(Random& random, const Case& c, double bound) {
  const Values sum = c.expected();
  const Slice out(sum.shape, random.pick({0, 0, 3}));
  const RandomEpilogue epilogue(random, out, random.pick({0, 2}));
  const Values expected = epilogue.applied(sum);
  on_every_isa([&] {
    const Convolution convolution(c.weight, c.bias, c.options);
    EXPECT_EQ(convolution.output(c.in.shape()), sum.shape);
    Workspace workspace;
    epilogue.prepare(out);
    convolution(c.in, out, workspace, epilogue.epilogue(), c.prologue);
    EXPECT_TRUE(near(out, expected, bound))
        << "from " << text(c.in.shape()) << ", kernel " << c.weight.shape[2] << ", stride "
        << c.options.stride << ", padding " << c.options.padding << ", dilation "
        << c.options.dilation;
    EXPECT_TRUE(out.margins_untouched());
  });
}

ConvolutionOptions random_options(Random& random) {
  ConvolutionOptions options;
  options.stride = random.pick({1, 1, 2, 3});
  options.padding = random.integer(0, 3);
  options.dilation = random.pick({1, 1, 2, 3});
  return options;
}

TEST(Convolution, is_its_reference) {
  Random random(51);
  for (int i = 0; i < 150; ++i) {
    ConvolutionOptions options = random_options(random);
    options.method = Method::direct;
    expect_reference(random, Case(random, random.pick({1, 1, 2, 3, 3, 4, 5}), options), kDirect);
  }
}

TEST(Convolution, with_bf16_weights_is_the_reference_with_those_weights) {
  Random random(52);
  for (int i = 0; i < 30; ++i) {
    ConvolutionOptions options = random_options(random);
    options.method = Method::direct;
    options.storage = Storage::bf16;
    expect_reference(random, Case(random, random.pick({1, 3, 4}), options), kDirect);
  }
}

TEST(Convolution, by_winograd_is_its_reference) {
  Random random(53);
  for (int i = 0; i < 100; ++i) {
    ConvolutionOptions options;
    options.padding = random.integer(0, 2);
    options.method = Method::winograd;
    expect_reference(random, Case(random, 3, options), kWinograd);
  }
}

TEST(Convolution, by_winograd_with_bf16_weights_is_within_3_percent) {
  Random random(54);
  for (int i = 0; i < 20; ++i) {
    ConvolutionOptions options;
    options.padding = 1;
    options.method = Method::winograd;
    options.storage = Storage::bf16;
    expect_reference(random, Case(random, 3, options), 0.03);
  }
}

TEST(Convolution, asked_for_winograd_where_it_cannot_be_is_direct) {
  Random random(55);
  for (const auto& [kernel, stride, dilation] :
       std::vector<std::array<int, 3>>{{3, 2, 1}, {3, 1, 2}, {1, 1, 1}, {4, 1, 1}}) {
    ConvolutionOptions options = {stride, 1, dilation};
    options.method = Method::winograd;
    expect_reference(random, Case(random, kernel, options), kDirect);
  }
}

TEST(Convolution, chosen_automatically_is_winograd_for_large_work_and_direct_for_small) {
  Random random(56);
  for (const int size : {8, 21}) {
    for (const int channels : {3, 40}) {
      const WeightTensor weight = random.weights({33, channels, 3, 3});
      const Slice in({1, size, size, channels}, 0, random);
      const Values expected = reference::convolution(Values(in), weight, {}, {1, 1, 1});
      on_every_isa([&] {
        const auto by = [&](Method method) {
          Tensor out({1, size, size, 33});
          Workspace workspace;
          Convolution(weight, {}, {1, 1, 1, method})(in, out, workspace);
          EXPECT_TRUE(near(out, expected, kWinograd));
          return out;
        };
        const bool large = size == 21 && channels == 40;
        const Tensor automatic = by(Method::automatic);
        EXPECT_EQ(same_bytes(automatic, by(Method::winograd)), large);
        EXPECT_EQ(same_bytes(automatic, by(Method::direct)), !large);
      });
    }
  }
}

TEST(Convolution, of_a_pixel_does_not_depend_on_the_rest_of_the_batch) {
  Random random(57);
  const WeightTensor weight = random.weights({33, 20, 3, 3});
  for (const Method method : {Method::direct, Method::winograd}) {
    const Slice in({5, 9, 9, 20}, 0, random);
    const Tensor all({5, 9, 9, 33}), one({1, 9, 9, 33});
    ConvolutionOptions options = {1, 1};
    options.method = method;
    on_every_isa([&] {
      const Convolution convolution(weight, {}, options);
      Workspace workspace;
      convolution(in, all, workspace);
      for (int image = 0; image < 5; ++image) {
        convolution(in.view().images(image, 1), one, workspace);
        EXPECT_TRUE(same_bytes(one, all.view().images(image, 1)));
      }
    });
  }
}

TEST(Convolution, takes_no_more_memory_the_second_time) {
  Random random(58);
  const Convolution convolution(random.weights({8, 16, 4, 4}), {}, {2, 1});
  const std::vector<float> scale = random.reals(16), shift = random.reals(16);
  const Slice in({1, 64, 64, 16}, 0, random);
  const Tensor out({1, 32, 32, 8});
  Workspace workspace;
  convolution(in, out, workspace, {}, {scale.data(), shift.data()});
  const std::size_t bytes = workspace.bytes();
  EXPECT_GT(bytes, 0u) << "a prologue needs scratch";
  convolution(in, out, workspace, {}, {scale.data(), shift.data()});
  EXPECT_EQ(workspace.bytes(), bytes);
}

TEST(Convolution, with_bf16_weights_takes_half_the_memory) {
  Random random(59);
  const WeightTensor weight = random.weights({64, 64, 3, 3});
  ConvolutionOptions options = {1, 1};
  options.method = Method::direct;
  const std::size_t bytes = Convolution(weight, {}, options).bytes();
  EXPECT_EQ(bytes, sizeof(float) * 64 * 64 * 9);
  options.storage = Storage::bf16;
  EXPECT_EQ(Convolution(weight, {}, options).bytes(), bytes / 2);
}

TEST(Convolution, refuses_misfit_weights_and_options) {
  Random random(60);
  const WeightTensor weight = random.weights({2, 3, 3, 3});
  EXPECT_THROW(Convolution(random.weights({2, 3, 3}), {}), Error);
  EXPECT_THROW(Convolution(random.weights({2, 3, 3, 2}), {}), Error);
  EXPECT_THROW(Convolution(random.weights({2, 3, 0, 0}), {}), Error);
  EXPECT_THROW(Convolution(weight, {1, 2, 3}), Error);
  EXPECT_THROW(Convolution(weight, {}, {0}), Error);
  EXPECT_THROW(Convolution(weight, {}, {1, -1}), Error);
  EXPECT_THROW(Convolution(weight, {}, {1, 0, 0}), Error);
  WeightTensor too_short = weight;
  too_short.values.pop_back();
  EXPECT_THROW(Convolution(too_short, {}), Error);
}

TEST(Convolution, refuses_misfit_tensors_and_epilogues) {
  Random random(61);
  const Convolution convolution(random.weights({2, 3, 3, 3}), {}, {1, 1});
  const Tensor in({1, 4, 5, 3}), out({1, 4, 5, 2}), wide({1, 4, 5, 4}), high({1, 5, 5, 2});
  Workspace workspace;
  EXPECT_NO_THROW(convolution(in, out, workspace));
  EXPECT_THROW(convolution(wide, out, workspace), Error);
  EXPECT_THROW(convolution(in, wide, workspace), Error);
  EXPECT_THROW(convolution(in, high, workspace), Error);
  const float two[] = {1, 1};
  Epilogue epilogue;
  epilogue.residual = &high.view();
  EXPECT_THROW(convolution(in, out, workspace, epilogue), Error);
  epilogue = {};
  epilogue.bias = two;
  EXPECT_THROW(convolution(in, out, workspace, epilogue), Error);
  epilogue = {};
  epilogue.scale = two;
  EXPECT_THROW(convolution(in, out, workspace, epilogue), Error);
}

}  // namespace
}  // namespace ps::nn
