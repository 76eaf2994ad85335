// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/depth_baselines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libps/core/error.h"
#include "libps/eval/depth_metrics.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

/// A floor: far above, near below.
Depth floor_depth(int rows, float scale) {
  Depth depth(rows, 10);
  for (int y = 0; y < rows; ++y) {
    const float height = (static_cast<float>(y) + 0.5f) / static_cast<float>(rows);
    depth.row(y).setTo(scale / (0.2f + height));
  }
  return depth;
}

TEST(DepthBaselines, constant_is_the_median_of_medians) {
  DepthBaselines baselines;
  for (const float depth : {1.f, 3.f, 50.f}) baselines.learn(Depth(4, 6, depth));
  const Depth constant = baselines.constant({3, 2});
  ASSERT_EQ(constant.size(), cv::Size(3, 2));
  for (const float depth : constant) EXPECT_EQ(depth, 3);
}

TEST(DepthBaselines, ramp_follows_the_rows_at_any_size) {
  DepthBaselines baselines;
  for (const float scale : {0.5f, 1.f, 4.f}) baselines.learn(floor_depth(128, scale));
  for (const int rows : {64, 200, 37}) {
    const Depth truth = floor_depth(rows, 1);
    const double ramp = depth_errors(baselines.ramp(truth.size()), truth).abs_rel;
    EXPECT_LT(ramp, 0.02) << rows;
    EXPECT_GT(depth_errors(baselines.constant(truth.size()), truth).abs_rel, 0.2);
  }
}

TEST(DepthBaselines, ramp_is_better_than_constant_on_a_walk) {
  DepthBaselines baselines;
  const Intrinsics k = intrinsics_from_fov(48, 36, 70);
  std::vector<Depth> depths;
  for (const Pose& pose : box_world_walk(30)) {
    depths.push_back(box_world_view(k, pose).depth);
    baselines.learn(depths.back());
  }
  double ramp = 0, constant = 0;
  for (const Depth& truth : depths) {
    ramp += depth_errors(median_scaled(baselines.ramp(truth.size()), truth), truth).abs_rel;
    constant += depth_errors(median_scaled(baselines.constant(truth.size()), truth), truth).abs_rel;
  }
  EXPECT_LT(ramp, constant);
}

/// Far to the left, near to the right.
Depth side_depth(cv::Size size, float scale) {
  Depth depth(size);
  for (int x = 0; x < size.width; ++x) {
    const float share = (static_cast<float>(x) + 0.5f) / static_cast<float>(size.width);
    depth.col(x).setTo(scale / (0.2f + share));
  }
  return depth;
}

TEST(DepthBaselines, mean_has_the_shape_of_the_other_images_at_any_size) {
  for (const cv::Size size : {cv::Size(96, 64), {200, 130}, {37, 21}}) {
    DepthBaselines baselines;
    const Depth truth = side_depth(size, 50);
    for (const float scale : {1.f, 4.f}) baselines.learn(side_depth({120, 90}, scale));
    baselines.learn(truth);
    // The geometric mean of 1 and 4, whatever the image that is left out has.
    const DepthErrors errors = depth_errors(baselines.mean(truth), side_depth(size, 2));
    EXPECT_LT(errors.abs_rel, 0.03) << size;
    EXPECT_GT(depth_errors(median_scaled(baselines.ramp(size), truth), truth).abs_rel, 0.2);
  }
}

TEST(DepthBaselines, mean_is_constant_where_others_know_nothing) {
  DepthBaselines baselines;
  Depth half(64, 64, 3.f);
  half.colRange(0, 32) = 0;
  baselines.learn(half);
  EXPECT_EQ(cv::norm(baselines.mean(half), Depth(64, 64, 3.f), cv::NORM_INF), 0);
  const Depth other(64, 64, 5.f);
  baselines.learn(other);  // the constant is the median of 3 and 5
  const Depth mean = baselines.mean(other);
  EXPECT_NEAR(mean(10, 10), baselines.constant({1, 1})(0, 0), 1e-5);
  EXPECT_NEAR(mean(10, 50), 3, 1e-5);
}

TEST(DepthBaselines, leave_unknown_depths_out) {
  DepthBaselines baselines;
  Depth depth(2, 3, 2.f);
  depth(0, 0) = 0, depth(0, 1) = std::nanf(""), depth(0, 2) = -1, depth(1, 0) = INFINITY;
  baselines.learn(depth);
  baselines.learn(Depth::zeros(4, 4));
  baselines.learn(Depth());
  EXPECT_EQ(baselines.constant({1, 1})(0, 0), 2);
  EXPECT_EQ(baselines.ramp({1, 1})(0, 0), 2);
  EXPECT_NEAR(baselines.mean(Depth::zeros(3, 3))(1, 1), 2, 1e-6);
}

TEST(DepthBaselines, know_nothing_before_they_learn) {
  EXPECT_THROW(DepthBaselines().constant({2, 2}), Error);
  EXPECT_THROW(DepthBaselines().ramp({2, 2}), Error);
  EXPECT_THROW(DepthBaselines().mean(Depth(2, 2, 1.f)), Error);
}

}  // namespace
}  // namespace ps
