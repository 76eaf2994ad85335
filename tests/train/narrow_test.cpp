// SPDX-License-Identifier: BSD-3-Clause
// Fused layers of narrow products give what libtorch's own, one after the other, give.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "libps/train/depth_net.h"
#include "libps/train/elu_taps.h"
#include "libps/train/layers.h"
#include "libps/train/leaky.h"
#include "libps/train/narrow_norm.h"
#include "libps/train/pixel_cnn.h"
#include "libps/train/upsample.h"
#include "libps/train/upsampled_sum.h"

namespace ps::train {
namespace {

const std::vector<std::vector<std::int64_t>> kShapes = {
    {2, 3, 5, 3}, {1, 1, 1, 1}, {2, 16, 8, 16}, {3, 33, 1, 2}};

/// Positive, negative and zero, of either layout.
Tensor signal(const std::vector<std::int64_t>& shape, std::int64_t seed, bool last) {
  Tensor x = torch::randn(shape, generator_of(seed, 0));
  x = x.masked_fill(x.abs() < .1, 0);
  return last ? x.contiguous(torch::MemoryFormat::ChannelsLast) : x;
}

Tensor gradient_of(const Tensor& y, const Tensor& x) {
  const Tensor above = torch::randn(y.sizes(), generator_of(9, 0)).to(y.scalar_type());
  return torch::autograd::grad({y}, {x}, {above})[0];
}

template <class Ours, class Theirs>
void expect_same_digits(const Ours& ours, const Theirs& theirs) {
  const NarrowProducts on(true);
  for (const auto& shape : kShapes) {
    for (const bool last : {false, true}) {
      const Tensor x = signal(shape, 1, last).to(torch::kBFloat16).requires_grad_();
      const Tensor a = ours(x), b = theirs(x);
      EXPECT_EQ(a.scalar_type(), torch::kBFloat16);
      EXPECT_TRUE(torch::equal(a, b)) << shape;
      EXPECT_TRUE(torch::equal(gradient_of(a, x), gradient_of(b, x))) << shape;
    }
  }
}

TEST(ReluUpsample, gives_libtorchs_digits_and_their_gradients) {
  expect_same_digits(
      [](const Tensor& x) { return relu_upsample_2x(x); },
      [](const Tensor& x) { return as_factor(upsample_2x(torch::relu(x.to(torch::kFloat32)))); });
}

TEST(Leaky, gives_libtorchs_digits_and_their_gradients) {
  expect_same_digits(
      [](const Tensor& x) { return leaky(x, .2F); },
      [](const Tensor& x) { return as_factor(torch::leaky_relu(x.to(torch::kFloat32), .2)); });
}

TEST(FusedLayers, leave_wide_products_as_they_are) {
  const Tensor x = signal({2, 3, 4, 4}, 1, true);
  EXPECT_TRUE(torch::equal(relu_upsample_2x(x), upsample_2x(torch::relu(x))));
  EXPECT_TRUE(torch::equal(leaky(x, .2F), torch::leaky_relu(x, .2)));
}

TEST(Leaky, hands_on_what_is_not_finite) {
  const NarrowProducts on(true);
  const float far = std::numeric_limits<float>::infinity();
  const Tensor x =
      torch::tensor({far, -far, std::nanf("")}).view({1, 3, 1, 1}).to(torch::kBFloat16);
  EXPECT_TRUE(torch::equal(torch::isfinite(leaky(x, .2F)), torch::zeros({1, 3, 1, 1}).gt(1)));
  EXPECT_TRUE(torch::isnan(leaky(x, .2F)[0][2]).item<bool>());
}

void expect_libtorchs_norm(float slope) {
  for (const std::vector<std::int64_t>& shape :
       {std::vector<std::int64_t>{2, 3, 5, 3}, {1, 16, 1, 2}, {3, 33, 40, 31}}) {
    const std::int64_t c = shape[1];
    // Means well off 0, and gradients that are not.
    const Tensor x = (signal(shape, 1, true) + torch::arange(c).view({1, c, 1, 1}))
                         .to(torch::kBFloat16)
                         .requires_grad_();
    const Tensor weight = torch::rand({c}, generator_of(2, 0)).add_(.5).requires_grad_();
    const Tensor bias = torch::randn({c}, generator_of(3, 0)).requires_grad_();
    const Tensor above = (torch::randn(shape, generator_of(4, 0)) + .3).to(torch::kBFloat16);
    std::vector<std::vector<Tensor>> results;
    for (const bool ours : {true, false}) {
      const Tensor mean = torch::full({c}, .5), var = torch::full({c}, 2.);
      const Tensor y =
          ours ? narrow_batch_norm(x, weight, bias, mean, var, slope)
               : torch::leaky_relu(torch::batch_norm(x.to(torch::kFloat32), weight, bias, mean, var,
                                                     true, .1, 1e-5, false),
                                   slope);
      EXPECT_EQ(y.scalar_type(), ours ? torch::kBFloat16 : torch::kFloat32);
      auto all = torch::autograd::grad({y}, {weight, bias, x}, {above.to(y.scalar_type())});
      EXPECT_EQ(all.back().scalar_type(), torch::kBFloat16);
      all.insert(all.begin(), {y, mean, var});
      results.push_back(std::move(all));
    }
    for (std::size_t i = 0; i < results[0].size(); ++i) {
      const bool narrow = results[0][i].scalar_type() == torch::kBFloat16;
      const Tensor a = results[0][i].to(torch::kFloat32), b = results[1][i].to(torch::kFloat32);
      EXPECT_TRUE(torch::allclose(a, b, narrow ? 1. / 128 : 1e-4, 1e-4))
          << i << ": " << (a - b).abs().max();
    }
  }
}

TEST(NarrowNorm, gives_what_libtorchs_batch_norm_gives_and_its_gradients) {
  expect_libtorchs_norm(1);
}

TEST(NarrowNorm, goes_on_to_a_leaky_relu) { expect_libtorchs_norm(.2F); }

TEST(ReluUpsampleToOne, stays_near_the_convolution_after_upsampling) {
  for (const std::vector<std::int64_t>& shape :
       {std::vector<std::int64_t>{2, 5, 7, 4}, {1, 32, 16, 24}, {3, 1, 1, 1}}) {
    const std::int64_t c = shape[1];
    std::vector<std::vector<Tensor>> results;
    for (const bool ours : {true, false}) {
      const NarrowProducts on(ours);
      Tensor x = signal(shape, 1, true).to(torch::kBFloat16);
      x = (ours ? x : x.to(torch::kFloat32)).requires_grad_();
      const Tensor weight = torch::randn({1, c, 3, 3}, generator_of(2, 0)).requires_grad_();
      const Tensor bias = torch::full({1}, .3).requires_grad_();
      const Tensor y = relu_upsample_to_one(x, weight, bias);
      EXPECT_EQ(y.scalar_type(), torch::kFloat32);
      const Tensor above = torch::randn(y.sizes(), generator_of(3, 0));
      auto all = torch::autograd::grad({y}, {x, weight, bias}, {above});
      all.push_back(y);
      results.push_back(std::move(all));
    }
    for (std::size_t i = 0; i < results[0].size(); ++i) {
      const Tensor a = results[0][i].to(torch::kFloat32), b = results[1][i];
      const double scale = b.abs().max().item<double>();
      EXPECT_LT((a - b).abs().max().item<double>(), .02 * scale + 1e-6) << i << ", " << shape;
    }
  }
}

TEST(Transposed, stays_near_libtorchs_where_products_are_narrow) {
  Parameters p("", 1);
  add_transposed(p, "up", 5, 3);
  p["up.bias"].detach().copy_(torch::tensor({.5, -1., 2.}));
  std::vector<std::vector<Tensor>> results;
  for (const bool narrow : {true, false}) {
    const NarrowProducts on(narrow);
    const Tensor x = signal({2, 5, 4, 7}, 1, true).requires_grad_();
    const Tensor y = transposed(p, "up", x);
    const Tensor above = torch::randn({2, 3, 8, 14}, generator_of(4, 0));
    auto all = torch::autograd::grad({y}, {x, p["up.weight"], p["up.bias"]}, {above});
    all.push_back(y);
    results.push_back(std::move(all));
  }
  for (std::size_t i = 0; i < results[0].size(); ++i) {
    const double scale = results[1][i].abs().max().item<double>();
    const double off = (results[0][i] - results[1][i]).abs().max().item<double>();
    EXPECT_LT(off, .02 * scale) << i;
    EXPECT_GT(off, 0) << i;  // or nothing was narrow
  }
}

TEST(EluTaps, stay_near_a_concatenation_and_a_gathering) {
  const std::int64_t cells = 40, c = 6;
  // Each cell reads, through each tap, a cell or none, and is read by one or none.
  const Tensor from = torch::full({cells, kTaps}, -1, torch::kInt64), to = from.clone();
  for (std::int64_t i = 0; i < cells; ++i) {
    for (std::int64_t tap = 0; tap < kTaps; ++tap) {
      const std::int64_t read = (7 * i + 3 * tap) % cells;
      if ((i + tap) % 4 == 0) continue;
      from[i][tap] = read;
      to[read][tap] = i * kTaps + tap;
    }
  }
  for (const bool gathers : {true, false}) {
    std::vector<std::vector<Tensor>> results;
    for (const bool narrow : {true, false}) {
      const NarrowProducts on(narrow);
      const Tensor x = (3 * signal({cells, c}, 1, false)).requires_grad_();
      const Tensor y = gathers ? elu_taps(x, from.view({-1}), to.view({-1})) : concat_elu(x);
      EXPECT_EQ(y.scalar_type(), narrow ? torch::kBFloat16 : torch::kFloat32);
      const Tensor above = torch::randn(y.sizes(), generator_of(4, 0)).to(torch::kBFloat16);
      const Tensor by_x = torch::autograd::grad({y}, {x}, {above.to(y.scalar_type())})[0];
      results.push_back({y.to(torch::kFloat32), by_x});
    }
    EXPECT_TRUE(torch::allclose(results[0][0], results[1][0], 1. / 256, 1e-6));
    // At 0 libtorch's ELU has the slope of what is below, 1, as ours.
    EXPECT_TRUE(torch::allclose(results[0][1], results[1][1], 1e-4, 1e-4))
        << (results[0][1] - results[1][1]).abs().max();
  }
  const NarrowProducts on(true);
  const float far = std::numeric_limits<float>::infinity();
  const Tensor odd = torch::tensor({200.F, -200.F, far, -far}).view({1, 4});
  const Tensor wanted = torch::tensor({200.F, -1.F, far, -1.F, -1.F, 200.F, -1.F, far});
  EXPECT_TRUE(torch::equal(concat_elu(odd).to(torch::kFloat32).view({-1}), wanted));
  EXPECT_TRUE(torch::isnan(concat_elu(torch::full({1, 1}, std::nanf("")))).all().item<bool>());
}

/// Of the norm of what is wanted.
double share_off(const Tensor& x, const Tensor& wanted) {
  return ((x - wanted).norm() / wanted.norm()).item<double>();
}

/// The narrow network's outputs and gradients against the wide one's, as shares of the largest.
template <class Forward>
void expect_near_wide(Parameters& parameters, const Forward& forward, double limit) {
  std::vector<std::map<std::string, Tensor>> results;
  for (const bool narrow : {true, false}) {
    const NarrowProducts on(narrow);
    for (const auto& [name, tensor] : parameters.trained()) tensor.mutable_grad() = Tensor();
    const Tensor y = forward();
    (y * torch::randn(y.sizes(), generator_of(6, 0))).sum().backward();
    std::map<std::string, Tensor> all = {{"", y.detach().clone()}};
    for (const auto& [name, tensor] : parameters.trained()) {
      // Of a bias before a norm nothing but rounding is left.
      if (tensor.dim() > 1) all[name] = tensor.grad().clone();
    }
    results.push_back(std::move(all));
  }
  for (const auto& [name, wide] : results[1]) {
    const double off = share_off(results[0].at(name), wide);
    EXPECT_LT(off, limit) << name;
    EXPECT_GT(off, 0) << name;  // or nothing was narrow
  }
}

TEST(NarrowProducts, of_a_depth_network_in_training_stay_near_wide_ones) {
  DepthNet net(4, 1);
  const Tensor x = signal({4, 3, 256, 256}, 1, true);
  expect_near_wide(
      net.parameters, [&] { return net.forward(x, true); }, .2);
}

TEST(NarrowProducts, of_a_pixel_cnn_stay_near_wide_ones) {
  constexpr int kCodes = 20;
  PixelCnn net(8, kCodes, 1);
  const Tensor codes = torch::randint(kCodes, {2, 8, 16}, generator_of(2, 0));
  const Tensor order = torch::stack(
      {torch::randperm(128, generator_of(3, 0)), torch::randperm(128, generator_of(4, 0))});
  expect_near_wide(
      net.parameters, [&] { return net.forward(codes, order); }, .2);
}

TEST(NormedConvolution, stays_near_a_convolution_and_a_norm) {
  Parameters p("", 1);
  add_convolution(p, "conv", 5, 16, 3);
  add_batch_norm(p, "norm", 16);
  const Tensor x = signal({2, 5, 12, 9}, 1, true);
  const NarrowProducts on(true);
  const Tensor theirs = batch_norm(p, "norm", convolution(p, "conv", x, 1, 1), true);
  const Tensor mean = p["norm.running_mean"].clone(), var = p["norm.running_var"].clone();
  p["norm.running_mean"].zero_();
  p["norm.running_var"].fill_(1);
  const Tensor ours = normed_convolution(p, "conv", "norm", x, 1, 1, 1, true);
  EXPECT_EQ(ours.scalar_type(), torch::kBFloat16);
  EXPECT_TRUE(torch::allclose(ours.to(torch::kFloat32), theirs, 1. / 256, 1e-4));
  EXPECT_TRUE(torch::allclose(p["norm.running_mean"], mean, 1e-4, 1e-5));
  EXPECT_TRUE(torch::allclose(p["norm.running_var"], var, 1e-4, 1e-5));
  // Without a norm, the product alone; with a slope, the leaky ReLU, too.
  for (const std::string norm : {"", "norm"}) {
    const Tensor before = convolution(p, "conv", x, 1, 1);
    const Tensor all =
        torch::leaky_relu(norm.empty() ? before : batch_norm(p, norm, before, true), .2);
    const Tensor sloping = normed_convolution(p, "conv", norm, x, 1, 1, .2F, true);
    EXPECT_TRUE(torch::allclose(sloping.to(torch::kFloat32), all, 1. / 128, 1e-3)) << norm;
    const Tensor still = norm.empty() ? before : batch_norm(p, norm, before, false);
    EXPECT_TRUE(torch::equal(normed_convolution(p, "conv", norm, x, 1, 1, .2F, false),
                             torch::leaky_relu(still, .2)));
  }
  // Not in training, it is the two, digit for digit.
  EXPECT_TRUE(torch::equal(normed_convolution(p, "conv", "norm", x, 1, 1, 1, false),
                           batch_norm(p, "norm", convolution(p, "conv", x, 1, 1), false)));
}

}  // namespace
}  // namespace ps::train
