// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/depth_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "libps/core/error.h"

namespace ps {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Depth random_depth(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.5f, 5);
  Depth depth(height, width);
  for (float& d : depth) d = random() % 5 == 0 ? 0 : uniform(random);
  return depth;
}

/// Share of pixels whose greater ratio is below the bound, by the definition.
double share_below(const Depth& depth, const Depth& truth, double bound) {
  int below = 0, all = 0;
  for (int i = 0; i < depth.rows * depth.cols; ++i) {
    const double d = depth(i / depth.cols, i % depth.cols);
    const double t = truth(i / depth.cols, i % depth.cols);
    if (d <= 0 || t <= 0) continue;
    ++all;
    if (d / t < bound && t / d < bound) ++below;
  }
  return static_cast<double>(below) / all;
}

TEST(DepthErrors, are_what_the_definitions_give) {
  const Depth depth = random_depth(37, 23, 1), truth = random_depth(37, 23, 2);
  std::vector<double> relative;
  double mean_abs = 0, square = 0;
  for (int i = 0; i < depth.rows * depth.cols; ++i) {
    const double d = depth(i / depth.cols, i % depth.cols);
    const double t = truth(i / depth.cols, i % depth.cols);
    if (d <= 0 || t <= 0) continue;
    relative.push_back(std::abs(d - t) / t);
    mean_abs += std::abs(d - t);
    square += (d - t) * (d - t);
  }
  const auto n = static_cast<double>(relative.size());
  const DepthErrors errors = depth_errors(depth, truth);
  EXPECT_EQ(errors.pixels, relative.size());
  double abs_rel = 0;
  for (const double r : relative) abs_rel += r / n;
  EXPECT_NEAR(errors.abs_rel, abs_rel, 1e-12);
  EXPECT_NEAR(errors.mean_abs, mean_abs / n, 1e-12);
  EXPECT_NEAR(errors.rmse, std::sqrt(square / n), 1e-12);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(errors.delta[k], share_below(depth, truth, std::pow(1.25, k + 1)), 1e-12);
  }
}

TEST(DepthErrors, median_of_an_odd_number_is_the_middle_one) {
  const Depth truth(1, 3, 1.f);
  const Depth depth = (Depth(1, 3) << 1.5f, 1.f, 1.25f);
  EXPECT_EQ(depth_errors(depth, truth).median_rel, 0.25);
}

TEST(DepthErrors, median_of_an_even_number_is_the_mean_of_the_middle_two) {
  const Depth truth(2, 2, 2.f);
  const Depth depth = (Depth(2, 2) << 2.f, 3.f, 2.5f, 6.f);
  EXPECT_EQ(depth_errors(depth, truth).median_rel, (0.25 + 0.5) / 2);
}

TEST(DepthErrors, of_equal_depths_are_zero) {
  const Depth depth = random_depth(9, 8, 1);
  const DepthErrors errors = depth_errors(depth, depth.clone());
  EXPECT_EQ(errors.abs_rel, 0);
  EXPECT_EQ(errors.median_rel, 0);
  EXPECT_EQ(errors.rmse, 0);
  EXPECT_EQ(errors.mean_abs, 0);
  EXPECT_EQ(errors.delta[0], 1);
}

TEST(DepthErrors, ratio_of_exactly_the_bound_is_not_below_it) {
  const DepthErrors errors = depth_errors(Depth(1, 1, 1.25f), Depth(1, 1, 1.f));
  EXPECT_EQ(errors.delta[0], 0);
  EXPECT_EQ(errors.delta[1], 1);
}

TEST(DepthErrors, unknown_depths_of_either_side_do_not_count) {
  const Depth depth = (Depth(1, 8) << 0.f, kNan, kInfinity, -1.f, 2.f, 2.f, 2.f, 3.f);
  const Depth truth = (Depth(1, 8) << 2.f, 2.f, 2.f, 2.f, 0.f, kNan, -kInfinity, 2.f);
  const DepthErrors errors = depth_errors(depth, truth);
  EXPECT_EQ(errors.pixels, 1u);
  EXPECT_EQ(errors.abs_rel, 0.5);
}

TEST(DepthErrors, sees_only_chosen_pixels) {
  const Depth truth(1, 2, 1.f);
  const Depth depth = (Depth(1, 2) << 4.f, 1.5f);
  EXPECT_EQ(depth_errors(depth, truth, (Mask(1, 2) << 0, 1)).abs_rel, 0.5);
  EXPECT_EQ(depth_errors(depth, truth, (Mask(1, 2) << 1, 0)).abs_rel, 3);
}

TEST(DepthErrors, of_no_pixel_are_nan) {
  for (const DepthErrors& errors :
       {depth_errors(Depth(), Depth()), depth_errors(Depth(2, 2, 0.f), Depth(2, 2, 1.f)),
        depth_errors(Depth(2, 2, 1.f), Depth(2, 2, 1.f), Mask::zeros(2, 2))}) {
    EXPECT_EQ(errors.pixels, 0u);
    for (const double figure : {errors.abs_rel, errors.median_rel, errors.rmse, errors.mean_abs,
                                errors.delta[0], errors.delta[2]}) {
      EXPECT_TRUE(std::isnan(figure));
    }
  }
}

TEST(DepthErrors, differing_sizes_throw) {
  EXPECT_THROW(depth_errors(Depth(2, 3, 1.f), Depth(3, 2, 1.f)), Error);
  EXPECT_THROW(depth_errors(Depth(2, 3, 1.f), Depth(2, 3, 1.f), Mask::ones(3, 2)), Error);
}

TEST(MedianScaled, takes_a_common_factor_away_and_nothing_else) {
  const Depth truth = random_depth(37, 23, 1);
  const Depth tripled = truth * 3;
  EXPECT_LT(depth_errors(median_scaled(tripled, truth), truth).abs_rel, 1e-6);
  const Depth other = random_depth(37, 23, 2);
  const Depth scaled = median_scaled(other, truth);
  for (int i = 1; i < 37 * 23; ++i) {
    EXPECT_FLOAT_EQ(scaled(i / 37, i % 37) * other(0, 0), other(i / 37, i % 37) * scaled(0, 0));
  }
}

TEST(MedianScaled, looks_at_pixels_that_both_know) {
  const Depth depth = (Depth(1, 5) << 2, 4, 6, 0, 100), truth = (Depth(1, 5) << 1, 2, 3, 9, kNan);
  EXPECT_FLOAT_EQ(median_scaled(depth, truth)(0, 4), 50);
  const Depth none = Depth::zeros(1, 5);
  EXPECT_EQ(median_scaled(depth, none)(0, 4), 100);
  EXPECT_THROW(median_scaled(depth, Depth(5, 1)), Error);
}

}  // namespace
}  // namespace ps
