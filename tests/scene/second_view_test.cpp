// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/second_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libps/core/error.h"
#include "libps/eval/depth_metrics.h"
#include "libps/geometry/scene_cloud.h"
#include "tests/support/box_world.h"
#include "tests/support/pose_pairs.h"

namespace ps {
namespace {

const Intrinsics kLens{320, 240, 260, 260, 159.5, 119.5};

View first_view() { return box_world_view(kLens, pose_at(0, 0, -2, 0)); }
View beside() { return box_world_view(kLens, pose_at(0.3, 0, -1.9, 0.15)); }

std::size_t added(const View& first, const View& second) {
  SceneCloud cloud;
  cloud.add(first, 0);
  return cloud.add(second, 1).added;
}

double abs_rel(const Depth& depth, const Depth& truth) {
  return depth_errors(depth, truth, truth > 0).abs_rel;
}

TEST(SecondView, depths_that_agree_stay_as_they_are) {
  const SecondView agreed = second_view(first_view(), beside());
  EXPECT_LT(agreed.before, 1e-3);
  EXPECT_LT(agreed.residual, 2e-3);
  EXPECT_LT(abs_rel(agreed.view.depth, beside().depth), 5e-3);
  EXPECT_LT(static_cast<double>(added(first_view(), agreed.view)),
            1.1 * static_cast<double>(added(first_view(), beside())) + 100);
}

TEST(SecondView, a_guess_agrees_better_and_brings_fewer_walls_twice) {
  const View truth = beside();
  for (const std::uint64_t seed : {1, 2, 3}) {
    View guess = truth;
    guess.depth = guessed_depth(truth.depth, 0.1, seed);
    const Depth before = guess.depth.clone();
    const SecondView agreed = second_view(first_view(), guess);
    EXPECT_EQ(cv::norm(guess.depth, before, cv::NORM_INF), 0) << "the argument was changed";
    EXPECT_LT(agreed.residual, agreed.before / 3);
    EXPECT_LT(abs_rel(agreed.view.depth, truth.depth), 0.6 * abs_rel(guess.depth, truth.depth));
    const std::size_t exact = added(first_view(), truth);
    EXPECT_LT(added(first_view(), agreed.view) - exact, (added(first_view(), guess) - exact) / 2);
  }
}

TEST(SecondView, without_an_overlap_nothing_changes) {
  View away = box_world_view(kLens, pose_at(0, 0, -2, M_PI));
  const SecondView agreed = second_view(first_view(), away);
  EXPECT_TRUE(std::isnan(agreed.before));
  EXPECT_TRUE(std::isnan(agreed.residual));
  EXPECT_EQ(cv::norm(agreed.view.depth, away.depth, cv::NORM_INF), 0);
}

TEST(SecondView, holes_stay_holes_and_the_smallest_views_pass) {
  View guess = beside();
  guess.depth = guessed_depth(guess.depth, 0.1, 5);
  guess.depth.rowRange(50, 90) = 0;
  const SecondView agreed = second_view(first_view(), guess);
  EXPECT_EQ(cv::countNonZero(agreed.view.depth == 0), 40 * kLens.width);
  const View tiny = box_world_view({1, 1, 1, 1, 0, 0}, pose_at(0, 0, -2, 0));
  EXPECT_EQ(second_view(first_view(), tiny).view.depth.size(), cv::Size(1, 1));
  EXPECT_EQ(second_view(tiny, first_view()).view.depth.size(), first_view().depth.size());
}

TEST(SecondView, refuses_unsound_views) {
  EXPECT_THROW(second_view(View(), first_view()), Error);
  EXPECT_THROW(second_view(first_view(), View()), Error);
}

}  // namespace
}  // namespace ps
