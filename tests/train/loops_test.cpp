// SPDX-License-Identifier: BSD-3-Clause
// Our own loops over float give what libtorch's operators give.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <limits>
#include <vector>

#include "libps/train/adam_loops.h"
#include "libps/train/log_depth_loss.h"
#include "libps/train/parameters.h"
#include "libps/train/picture_loops.h"

namespace ps::train {
namespace {

Tensor noise(torch::IntArrayRef shape, std::int64_t seed) {
  return torch::randn(shape, generator_of(seed, 0));
}

Tensor last(const Tensor& x) { return x.contiguous(torch::MemoryFormat::ChannelsLast); }

TEST(AdamLoops, move_weights_as_operators_do) {
  AdamRates rates;
  rates.gradient = .7F;
  rates.beta1 = .8F;
  rates.shrink = .99F;
  rates.rate = .05F;
  rates.correction = 3;
  rates.to_average = .1F;
  // Of one layout, of another, of one value, of more than one thread's share.
  for (const bool same : {true, false}) {
    for (const std::vector<std::int64_t>& shape :
         {std::vector<std::int64_t>{4, 3, 5, 5}, {1, 1, 1, 1}, {64, 40, 4, 4}}) {
      std::vector<std::vector<Tensor>> results;
      for (const bool ours : {true, false}) {
        const Tensor value = last(noise(shape, 1)), first = last(noise(shape, 2)),
                     second = last(noise(shape, 3).square()), average = last(noise(shape, 4));
        const Tensor gradient = same ? last(noise(shape, 5)) : noise(shape, 5);
        const std::vector<Tensor> moved = {value, first, second, average};
        std::vector<Tensor> before;
        for (const Tensor& x : moved) before.push_back(x.clone());
        (ours ? move_along : move_along_by_operators)(gradient, value, first, second, average,
                                                      rates);
        results.push_back(moved);
        for (std::size_t i = 0; i < moved.size(); ++i) {
          EXPECT_FALSE(torch::allclose(moved[i], before[i], 1e-3)) << i << shape;
        }
      }
      for (std::size_t i = 0; i < results[0].size(); ++i) {
        EXPECT_TRUE(torch::allclose(results[0][i], results[1][i], 1e-5, 1e-6)) << i << shape;
      }
    }
  }
}

TEST(AdamLoops, sum_squares_of_any_layout) {
  const Tensor x = noise({50, 31, 7, 3}, 1);
  const double wanted = x.to(torch::kFloat64).square().sum().item<double>();
  for (const Tensor& of :
       std::vector<Tensor>{x, last(x), x.transpose(0, 1), x.to(torch::kFloat64)}) {
    EXPECT_NEAR(sum_of_squares(of), wanted, 1e-5 * wanted);
  }
  EXPECT_NEAR(sum_of_squares(x.slice(0, 0, 50, 2)),
              x.slice(0, 0, 50, 2).square().sum().item<double>(), 1e-5 * wanted);
  EXPECT_TRUE(std::isnan(sum_of_squares(torch::full({40}, std::nanf("")))));
  EXPECT_FALSE(std::isfinite(sum_of_squares(torch::full({40}, 3e38F))));
}

TEST(LogDepthLoss, and_its_gradients_are_the_operators) {
  for (const std::vector<std::int64_t>& shape :
       {std::vector<std::int64_t>{3, 1, 40, 56}, {1, 1, 1, 1}, {2, 1, 17, 9}, {1, 1, 3, 1}}) {
    for (const double known_share : {1., .6, 0.}) {
      const Tensor known =
          (torch::rand(shape, generator_of(3, 0)) < known_share).to(torch::kFloat32);
      const float nothing = std::numeric_limits<float>::quiet_NaN();
      const Tensor truth = noise(shape, 2).masked_fill(known == 0, nothing);
      std::vector<LogDepthLoss> losses;
      std::vector<Tensor> gradients;
      for (const bool ours : {true, false}) {
        const auto loss = ours ? log_depth_loss : log_depth_loss_by_operators;
        const Tensor depth = noise(shape, 1).requires_grad_();
        losses.push_back(loss(depth, truth, known));
        gradients.push_back(torch::autograd::grad({losses.back().sum * 2}, {depth})[0]);
      }
      EXPECT_TRUE(torch::allclose(losses[0].sum, losses[1].sum, 1e-5, 1e-6)) << shape;
      EXPECT_TRUE(torch::allclose(losses[0].value, losses[1].value, 1e-5, 1e-6)) << shape;
      EXPECT_TRUE(torch::allclose(losses[0].gradient, losses[1].gradient, 1e-5, 1e-6)) << shape;
      EXPECT_TRUE(torch::allclose(gradients[0], gradients[1], 1e-4, 1e-7))
          << shape << (gradients[0] - gradients[1]).abs().max();
      EXPECT_EQ(gradients[0].abs().max().item<double>() > 0, known_share > 0);
    }
  }
}

TEST(SampledUpright, samples_as_libtorchs_grid_does) {
  // Upright, mirrored, shifted beyond the border.
  const Tensor theta = torch::tensor({1., 0., 0., 0., 1., 0.,    //
                                      -.7, 0., .2, 0., .7, -.3,  //
                                      .9, 0., .4, 0., -1.2, 0.})
                           .view({3, 2, 3})
                           .to(torch::kFloat32);
  for (const int channels : {3, 1}) {
    const Tensor x = noise({3, channels, 13, 22}, 1);
    const Tensor grid = torch::nn::functional::affine_grid(theta, x.sizes(), false);
    for (const bool nearest : {false, true}) {
      const Tensor ours = sampled_upright(x, theta, nearest);
      const Tensor theirs = torch::grid_sampler(x, grid, nearest ? 1 : 0, 1, false);
      // The nearest of two that are as near may be either.
      const Tensor off = ((ours - theirs).abs() > 1e-4).to(torch::kFloat32).mean();
      EXPECT_LE(off.item<double>(), nearest ? .02 : 0) << channels << nearest;
    }
  }
}

TEST(SampledUpright, copies_the_nearest_and_takes_other_types) {
  const float far = std::numeric_limits<float>::infinity();
  const Tensor x = torch::tensor({1.F, far, 2.F, 3.F}).view({1, 1, 2, 2});
  const Tensor same = torch::tensor({1.F, 0.F, 0.F, 0.F, 1.F, 0.F}).view({1, 2, 3});
  EXPECT_TRUE(torch::equal(sampled_upright(x, same, true), x));
  const Tensor wide = noise({1, 3, 5, 4}, 1), turned = same * .8;
  EXPECT_TRUE(torch::allclose(sampled_upright(wide.to(torch::kFloat64), turned, false),
                              sampled_upright(wide, turned, false).to(torch::kFloat64), 1e-5,
                              1e-5));
  EXPECT_THROW(sampled_upright(wide, torch::zeros({2, 2, 3}), false), c10::Error);
  const Tensor none = torch::zeros({0, 3, 4, 4});
  EXPECT_EQ(sampled_upright(none, torch::zeros({0, 2, 3}), false).size(0), 0);
}

TEST(Tinted, changes_colours_as_operators_do) {
  const Tensor color = torch::rand({3, 3, 9, 14}, generator_of(1, 0)) * 2 - 1;
  Tints tints;
  tints.gamma = torch::tensor({.7, 1., 1.4}).view({3, 1, 1, 1}).to(torch::kFloat32);
  tints.gain = torch::tensor({.8, 1., 1.3}).view({3, 1, 1, 1}).to(torch::kFloat32);
  tints.tint = torch::exp(.1 * noise({3, 3, 1, 1}, 2));
  tints.saturation = torch::tensor({.5, 1., 1.4}).view({3, 1, 1, 1}).to(torch::kFloat32);
  tints.contrast = torch::tensor({1.2, 1., .8}).view({3, 1, 1, 1}).to(torch::kFloat32);
  const Tensor ours = tinted(color, tints), theirs = tinted_by_operators(color, tints);
  EXPECT_TRUE(torch::allclose(ours, theirs, 1e-5, 1e-5)) << (ours - theirs).abs().max();
  EXPECT_FALSE(torch::allclose(ours[0], color[0], .1));
  EXPECT_GE(ours.min().item<double>(), -1);
  EXPECT_LE(ours.max().item<double>(), 1);
}

}  // namespace
}  // namespace ps::train
