// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/elementwise.h"

#include <gtest/gtest.h>

#include <limits>

#include "libps/core/error.h"
#include "libps/nn/kernels/kernels.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

using reference::Values;

constexpr int kCases = 120;
constexpr double kUnits = 3e-7;  ///< the contract of the header

using Unary = std::function<void(const TensorView&, const TensorView&)>;

/// Over random shapes and strides, into another tensor and in place.
void expect_map(const Unary& run, const std::function<Values(const Values&)>& expected,
                double bound, int times_channels = 1) {
  Random random(1);
  for (int i = 0; i < kCases; ++i) {
    const Shape shape = random.shape();
    const Slice in(shape, random.pick({0, 0, 3, 16}), random, -6, 6);
    const Values result = expected(Values(in));
    Shape out_shape = shape;
    out_shape.channels *= times_channels;
    on_every_isa([&] {
      const Slice out(out_shape, random.pick({0, 0, 5, 16}));
      run(in, out);
      EXPECT_TRUE(near(out, result, bound));
      EXPECT_TRUE(out.margins_untouched());
      if (times_channels > 1) return;
      const Slice both(shape, random.pick({0, 1}));
      copy(in, both);
      run(both, both);
      EXPECT_TRUE(same_bytes(both, out));
      EXPECT_TRUE(both.margins_untouched());
    });
  }
}

TEST(Elementwise, activate_is_its_reference) {
  for (const float slope : {0.0f, 0.2f, 1.0f}) {
    expect_map([&](const auto& in, const auto& out) { activate(in, out, {slope}); },
               [&](const Values& in) { return reference::activation(in, slope); }, 1e-7);
  }
}

TEST(Elementwise, elu_is_its_reference) {
  expect_map(
      elu, [](const Values& in) { return reference::map(in, reference::elu); }, kUnits);
}

TEST(Elementwise, concat_elu_is_its_reference) {
  expect_map(concat_elu, reference::concat_elu, kUnits, 2);
}

TEST(Elementwise, tanh_is_its_reference) {
  expect_map(
      nn::tanh,
      [](const Values& in) { return reference::map(in, [](double x) { return std::tanh(x); }); },
      kUnits);
}

TEST(Elementwise, sigmoid_is_its_reference) {
  expect_map(
      sigmoid, [](const Values& in) { return reference::map(in, reference::sigmoid); }, kUnits);
}

TEST(Elementwise, scale_shift_is_its_reference) {
  Random random(2);
  const std::vector<float> scale = random.reals(70, -2, 2), shift = random.reals(70, -2, 2);
  for (const float slope : {1.0f, 0.2f}) {
    expect_map([&](const auto& in,
                   const auto& out) { scale_shift(in, scale.data(), shift.data(), out, {slope}); },
               [&](const Values& in) {
                 return reference::activation(reference::scale_shift(in, scale, shift), slope);
               },
               kUnits);
  }
}

TEST(Elementwise, add_is_its_reference) {
  Random random(3);
  for (int i = 0; i < kCases; ++i) {
    const Shape shape = random.shape();
    const Slice a(shape, random.pick({0, 0, 2}), random), b(shape, random.pick({0, 0, 7}), random);
    const Values sum = reference::map(Values(a), Values(b), std::plus<>());
    for (const float slope : {1.0f, 0.0f}) {
      const Values expected = reference::activation(sum, slope);
      on_every_isa([&] {
        const Slice out(shape, random.pick({0, 0, 9}));
        add(a, b, out, {slope});
        EXPECT_TRUE(near(out, expected, 1.2e-7));
        EXPECT_TRUE(out.margins_untouched());
      });
    }
  }
}

TEST(Elementwise, gated_add_is_its_reference) {
  Random random(4);
  for (int i = 0; i < kCases; ++i) {
    const Shape shape = random.shape();
    const Slice base(shape, random.pick({0, 0, 2}), random),
        value(shape, random.pick({0, 0, 7}), random, -3, 3),
        gate(shape, random.pick({0, 0, 1}), random, -9, 9);
    const Values weight = reference::map(Values(gate), reference::sigmoid);
    const Values expected = reference::map(
        Values(base), reference::map(Values(value), weight, std::multiplies<>()), std::plus<>());
    on_every_isa([&] {
      const Slice out(shape, random.pick({0, 0, 9}));
      gated_add(base, value, gate, out);
      EXPECT_TRUE(near(out, expected, kUnits));
      EXPECT_TRUE(out.margins_untouched());
      const Slice both(shape, 1);
      copy(base, both);
      gated_add(both, value, gate, both);
      EXPECT_TRUE(same_bytes(both, out));
    });
  }
}

/// Every `step`-th of all floats there are, in order of their bits.
std::vector<float> floats_of_all_sizes(std::uint32_t step) {
  std::vector<float> values;
  for (std::uint64_t bits = 0; bits < std::uint64_t{1} << 32; bits += step) {
    const auto word = static_cast<std::uint32_t>(bits);
    float value;
    std::memcpy(&value, &word, sizeof value);
    values.push_back(value);
  }
  return values;
}

/// How many floats lie between; NaN equals NaN.
double ulps(float got, double exact) {
  if (std::isnan(exact)) return std::isnan(got) ? 0 : 1e9;
  const auto nearest = static_cast<float>(exact);
  if (std::isinf(nearest) || std::isinf(got)) return nearest == got ? 0 : 1e9;
  const int exponent = std::max(-126, std::ilogb(exact == 0 ? 1e-45 : exact));
  return std::abs(got - exact) / std::ldexp(1.0, exponent - 23);
}

void expect_ulps(void (*kernel)(const float*, float*, std::size_t), double (*exact)(double),
                 double most) {
  const std::vector<float> in = floats_of_all_sizes(20011);
  std::vector<float> out(in.size());
  kernel(in.data(), out.data(), in.size());
  double worst = 0;
  float where = 0;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const double error = ulps(out[i], exact(in[i]));
    if (error > worst) {
      worst = error;
      where = in[i];
    }
  }
  EXPECT_LE(worst, most) << "at " << where;
}

TEST(Elementwise, exp_is_within_2_ulps_for_floats_of_all_sizes) {
  on_every_isa([] {
    expect_ulps(
        kernels().exp, [](double x) { return std::exp(x); }, 2);
  });
}

TEST(Elementwise, elu_is_within_2_ulps_for_floats_of_all_sizes) {
  on_every_isa([] {
    const auto kernel = [](const float* in, float* out, std::size_t n) {
      kernels().elu(in, out, n, 1);
    };
    expect_ulps(kernel, reference::elu, 2);
  });
}

TEST(Elementwise, tanh_is_within_3_ulps_for_floats_of_all_sizes) {
  on_every_isa([] {
    expect_ulps(
        kernels().tanh, [](double x) { return std::tanh(x); }, 3);
  });
}

TEST(Elementwise, sigmoid_is_within_3_ulps_for_floats_of_all_sizes) {
  on_every_isa([] { expect_ulps(kernels().sigmoid, reference::sigmoid, 3); });
}

TEST(Elementwise, infinities_and_nan_go_where_they_should) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const float in[] = {kInf, -kInf, std::nanf(""), 0.0f, -0.0f, 88.8f, -104};
  constexpr std::size_t kCount = std::size(in);
  on_every_isa([&] {
    float out[kCount];
    kernels().exp(in, out, kCount);
    EXPECT_EQ(out[0], kInf);
    EXPECT_EQ(out[1], 0.0f);
    EXPECT_TRUE(std::isnan(out[2]));
    EXPECT_EQ(out[3], 1.0f);
    EXPECT_EQ(out[5], kInf);
    EXPECT_EQ(out[6], 0.0f);
    kernels().tanh(in, out, kCount);
    EXPECT_EQ(out[0], 1.0f);
    EXPECT_EQ(out[1], -1.0f);
    EXPECT_TRUE(std::isnan(out[2]));
    EXPECT_TRUE(std::signbit(out[4]) && out[4] == 0);
    kernels().sigmoid(in, out, kCount);
    EXPECT_EQ(out[0], 1.0f);
    EXPECT_EQ(out[1], 0.0f);
    EXPECT_TRUE(std::isnan(out[2]));
    EXPECT_EQ(out[3], 0.5f);
    kernels().activate(in, out, kCount, 0);
    EXPECT_TRUE(std::isnan(out[2])) << "a ReLU does not hide a NaN";
    const float zeros[kCount] = {};
    kernels().maximum(in, zeros, out, kCount);
    EXPECT_TRUE(std::isnan(out[2]));
    kernels().maximum(zeros, in, out, kCount);
    EXPECT_TRUE(std::isnan(out[2]));
    EXPECT_EQ(out[1], 0.0f);
  });
}

TEST(Elementwise, a_value_has_the_same_bytes_wherever_it_stands) {
  Random random(5);
  const std::vector<float> in = random.reals(200, -20, 20), other = random.reals(200, -3, 3);
  using Kernel = std::function<void(const float*, const float*, float*, std::size_t)>;
  const std::vector<Kernel> all = {
      [](auto a, auto, auto out, auto n) { kernels().elu(a, out, n, -1); },
      [](auto a, auto, auto out, auto n) { kernels().tanh(a, out, n); },
      [](auto a, auto, auto out, auto n) { kernels().sigmoid(a, out, n); },
      [](auto a, auto, auto out, auto n) { kernels().exp(a, out, n); },
      [](auto a, auto b, auto out, auto n) { kernels().scale_shift(a, b, b, out, n, 0.2f); },
      [](auto a, auto b, auto out, auto n) { kernels().gated_add(a, b, a, out, n); },
      [](auto a, auto b, auto out, auto n) { kernels().mix(a, b, 0.3f, 0.6f, out, n); }};
  on_every_isa([&] {
    for (std::size_t k = 0; k < all.size(); ++k) {
      std::vector<float> whole(in.size()), part(in.size());
      all[k](in.data(), other.data(), whole.data(), in.size());
      for (std::size_t count = 1; count < 70; ++count) {
        const std::size_t at = count * 7 % 97;
        all[k](in.data() + at, other.data() + at, part.data(), count);
        EXPECT_EQ(std::memcmp(part.data(), whole.data() + at, count * sizeof(float)), 0)
            << "kernel " << k << ", " << count << " values from " << at;
      }
    }
  });
}

TEST(Elementwise, shapes_that_differ_are_refused) {
  const Tensor a({1, 2, 3, 4}), wide({1, 2, 3, 8}), other({1, 3, 2, 4});
  const std::vector<float> ones(8, 1.0f);
  for (const Tensor* wrong : {&wide, &other}) {
    EXPECT_THROW(activate(a, *wrong, kRelu), Error);
    EXPECT_THROW(elu(a, *wrong), Error);
    EXPECT_THROW(nn::tanh(a, *wrong), Error);
    EXPECT_THROW(sigmoid(a, *wrong), Error);
    EXPECT_THROW(scale_shift(a, ones.data(), ones.data(), *wrong), Error);
    EXPECT_THROW(add(a, *wrong, a), Error);
    EXPECT_THROW(add(a, a, *wrong), Error);
    EXPECT_THROW(gated_add(a, *wrong, a, a), Error);
    EXPECT_THROW(gated_add(a, a, *wrong, a), Error);
    EXPECT_THROW(gated_add(a, a, a, *wrong), Error);
  }
  EXPECT_THROW(concat_elu(a, a), Error);
  EXPECT_NO_THROW(concat_elu(a, wide));
}

}  // namespace
}  // namespace ps::nn
