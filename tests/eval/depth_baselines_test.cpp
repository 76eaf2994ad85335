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

TEST(DepthBaselines, leave_unknown_depths_out) {
  DepthBaselines baselines;
  Depth depth(2, 3, 2.f);
  depth(0, 0) = 0, depth(0, 1) = std::nanf(""), depth(0, 2) = -1, depth(1, 0) = INFINITY;
  baselines.learn(depth);
  baselines.learn(Depth::zeros(4, 4));
  baselines.learn(Depth());
  EXPECT_EQ(baselines.constant({1, 1})(0, 0), 2);
  EXPECT_EQ(baselines.ramp({1, 1})(0, 0), 2);
}

TEST(DepthBaselines, know_nothing_before_they_learn) {
  EXPECT_THROW(DepthBaselines().constant({2, 2}), Error);
  EXPECT_THROW(DepthBaselines().ramp({2, 2}), Error);
}

}  // namespace
}  // namespace ps
