// SPDX-License-Identifier: BSD-3-Clause
// Targets of points and PSNR, odd inputs, threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "tests/scene/budget_pictures.h"
#include "tests/support/box_world.h"
#include "tests/support/same_points.h"

namespace ps {
namespace {

class BudgetOfPoints : public testing::TestWithParam<double> {};

TEST_P(BudgetOfPoints, is_met_within_five_per_cent) {
  const Cloud whole = picture_cloud(half_and_half, two_metres);
  BudgetOptions options;
  options.points = static_cast<std::size_t>(GetParam() * static_cast<double>(whole.size()));
  BudgetReport report;
  const Cloud thin = thinned(whole, kFront, options, &report);
  EXPECT_LE(thin.size(), options.points);
  EXPECT_GE(thin.size(), options.points * 0.95);
  // Only what is below a tolerance's reach is merged across edges.
  EXPECT_EQ(report.pixels > options.pixels, GetParam() < 0.1);
}

INSTANTIATE_TEST_SUITE_P(of_all, BudgetOfPoints, testing::Values(0.9, 0.6, 0.3, 0.05, 0.003));

TEST(Budget, more_points_than_there_are_is_no_limit) {
  const Cloud whole = picture_cloud(noise, two_metres);
  BudgetOptions options;
  options.points = 2 * whole.size();
  EXPECT_EQ(thinned(whole, kFront, options).size(), whole.size());
}

TEST(Budget, a_psnr_is_met_in_every_view_by_no_more_points_than_a_higher_one) {
  const std::vector<Pose> poses = box_world_walk(3);
  Cloud whole;
  std::vector<PlannedView> views;
  for (const Pose& pose : poses) {
    whole += lift(box_world_view(kCamera, pose));
    views.push_back({kCamera, pose});
  }
  std::size_t last = 0;
  for (const double psnr : {30., 34., 38.}) {
    BudgetOptions options;
    options.psnr = psnr;
    BudgetReport report;
    const Cloud thin = thinned(whole, views, options, &report);
    EXPECT_GE(report.psnr, psnr);
    double worst = 1000;
    for (const Pose& pose : poses) worst = std::min(worst, psnr_of(thin, whole, pose));
    EXPECT_NEAR(worst, report.psnr, 1e-9);
    EXPECT_LT(thin.size(), whole.size());
    EXPECT_GT(thin.size(), last);
    last = thin.size();
  }
}

TEST(Budget, a_psnr_out_of_reach_keeps_all_and_points_come_before_it) {
  const Cloud whole = picture_cloud(noise, two_metres);
  const std::vector<PlannedView> coarse = {{resized(kCamera, 40, 30), Pose::Identity()}};
  BudgetOptions options;
  options.psnr = 300;
  BudgetReport report;
  EXPECT_TRUE(same_points(thinned(whole, coarse, options, &report), whole));
  EXPECT_TRUE(std::isinf(report.psnr));
  EXPECT_LT(report.pixels, 0.25);  // points are so far apart
  // What is in reach with finer merging is found.
  const std::size_t usual = thinned(whole, coarse).size();
  options.psnr = 21;
  const std::size_t finer = thinned(whole, coarse, options, &report).size();
  EXPECT_GE(report.psnr, 21);
  EXPECT_LT(report.pixels, 0.5);
  EXPECT_GT(finer, usual);
  EXPECT_LT(finer, whole.size());
  options.points = 2000;
  EXPECT_LE(thinned(whole, coarse, options, &report).size(), 2000u);
  EXPECT_LT(report.psnr, 21);
}

TEST(Budget, an_empty_cloud_stays_empty_and_one_point_stays) {
  BudgetReport report;
  EXPECT_TRUE(thinned(Cloud(), kFront, {}, &report).empty());
  EXPECT_EQ(report.points, 0u);
  Cloud one;
  one.push_back(picture_cloud(smooth, two_metres)[1234]);
  EXPECT_TRUE(same_points(thinned(one, kFront), one));
}

TEST(Budget, coincident_points_become_one_of_their_mean_colour) {
  Cloud whole;
  for (int i = 0; i < 100001; ++i) {
    Point p;
    p.z = 1;
    p.r = i % 2 == 0 ? 100 : 200;
    p.view = static_cast<std::uint16_t>(7 + i);
    p.footprint = 0.01f;
    whole.push_back(p);
  }
  const Cloud thin = thinned(whole, kFront);
  ASSERT_EQ(thin.size(), 1u);
  EXPECT_EQ(thin[0].r, 150);
  EXPECT_EQ(thin[0].view, 7);
  EXPECT_FLOAT_EQ(thin[0].footprint, 0.01f);
}

TEST(Budget, without_planned_views_only_broken_points_go) {
  Cloud whole = picture_cloud(plain, two_metres);
  BudgetOptions drop;
  drop.drop_unseen = true;
  EXPECT_TRUE(same_points(thinned(whole, {}), whole));
  EXPECT_TRUE(same_points(thinned(whole, {}, drop), whole));
}

TEST(Budget, points_behind_and_beside_the_views_are_kept_unless_they_are_not_wanted) {
  Cloud unseen;
  for (const float z : {-2.f, 0.f, 1.f}) {
    for (int i = 0; i < 100; ++i) {
      Point p;
      p.x = 3 + 1e-4f * static_cast<float>(i);
      p.z = z;
      unseen.push_back(p);
    }
  }
  Cloud whole = unseen;
  whole += picture_cloud(plain, two_metres);
  BudgetReport report;
  const Cloud thin = thinned(whole, kFront, {}, &report);
  EXPECT_EQ(report.unseen, unseen.size());
  EXPECT_TRUE(same_points(thin, unseen, unseen.size()));
  BudgetOptions drop;
  drop.drop_unseen = true;
  EXPECT_EQ(thinned(whole, kFront, drop).size(), thin.size() - unseen.size());
}

TEST(Budget, points_that_are_not_finite_are_dropped) {
  const Cloud whole = picture_cloud(smooth, two_metres);
  Cloud broken = whole;
  for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
    Point p = whole[5];
    p.y = bad;
    broken.push_back(p);
  }
  BudgetReport report;
  EXPECT_TRUE(same_points(thinned(broken, kFront, {}, &report), thinned(whole, kFront)));
  EXPECT_EQ(report.not_finite, 3u);
}

TEST(Budget, huge_tiny_and_distant_places_are_thinned_alike) {
  const Cloud whole = picture_cloud(half_and_half, two_metres);
  const std::size_t usual = thinned(whole, kFront).size();
  for (const float scale : {1e-2f, 37.f, 1e6f}) {
    Cloud scaled = whole;
    for (Point& p : scaled) p.getVector3fMap() *= scale;
    const auto count = static_cast<double>(thinned(scaled, kFront).size());
    EXPECT_NEAR(count / static_cast<double>(usual), 1, 0.05) << scale;
  }
  Cloud far = whole;
  Pose there = Pose::Identity();
  there.translation() = Eigen::Vector3d(512, -700, 900);
  for (Point& p : far) p.getVector3fMap() += there.translation().cast<float>();
  const auto count = static_cast<double>(thinned(far, {{kCamera, there}}).size());
  EXPECT_NEAR(count / static_cast<double>(usual), 1, 0.05);
}

TEST(Budget, progress_rises_to_one_in_small_steps_whatever_the_target) {
  const Cloud whole = picture_cloud(half_and_half, two_metres);
  BudgetOptions few, alike, beyond;
  few.points = whole.size() / 300;
  alike.psnr = 38;
  beyond.psnr = 300;
  for (BudgetOptions options : {BudgetOptions(), few, alike, beyond}) {
    std::vector<double> told = {0};
    options.progress = [&](double done) { told.push_back(done); };
    thinned(whole, kFront, options);
    EXPECT_EQ(told.back(), 1);
    EXPECT_GT(told.size(), 100u);
    for (std::size_t i = 1; i < told.size(); ++i) {
      EXPECT_GE(told[i], told[i - 1]);
      EXPECT_LT(told[i] - told[i - 1], 0.3);
    }
  }
}

TEST(Budget, stops_where_its_progress_throws) {
  const Cloud whole = picture_cloud(half_and_half, two_metres);
  BudgetOptions options;
  options.points = whole.size() / 300;
  for (const double last : {0.0, 0.05, 0.2, 0.4, 0.7, 0.95}) {
    double told = 0;
    std::atomic<int> after{0};
    options.progress = [&](double done) {
      told = done;
      if (done < last) return;
      ++after;
      throw Error("progress", "stop");
    };
    EXPECT_THROW(thinned(whole, kFront, options), Error) << last;
    EXPECT_GE(told, last);
    EXPECT_LE(after, 64) << last;  // each thread once
  }
}

TEST(Budget, bytes_do_not_depend_on_threads) {
  Cloud whole;
  std::vector<PlannedView> views;
  for (const Pose& pose : box_world_walk(4)) {
    whole += lift(box_world_view(kCamera, pose));
    views.push_back({kCamera, pose});
  }
  BudgetOptions coarse, targets;
  coarse.tolerance = 0.05;
  targets.psnr = 38;
  targets.points = whole.size() / 20;
  for (const BudgetOptions& options : {coarse, targets}) {
    set_threads(1);
    const Cloud one = thinned(whole, views, options);
    set_threads(2);
    const Cloud two = thinned(whole, views, options);
    set_threads(0);
    EXPECT_LT(one.size(), whole.size() / 2);
    EXPECT_TRUE(same_points(one, two));
  }
}

TEST(Budget, unsound_views_and_options_are_refused) {
  const Cloud whole = picture_cloud(plain, two_metres);
  PlannedView flat = kFront.front(), mirrored = kFront.front();
  flat.intrinsics.fx = 0;
  mirrored.world_from_cam.linear()(0, 0) = -1;
  EXPECT_THROW(thinned(whole, {flat}), Error);
  EXPECT_THROW(thinned(whole, {kFront[0], mirrored}), Error);
  const auto refused = [&](const std::function<void(BudgetOptions&)>& spoil) {
    BudgetOptions options;
    spoil(options);
    EXPECT_THROW(thinned(whole, kFront, options), Error);
  };
  const double nan = std::nan("");
  for (const double bad : {nan, 0., -1., 5.}) refused([&](auto& o) { o.pixels = bad; });
  for (const double bad : {nan, 0., 1.1}) refused([&](auto& o) { o.spacing = bad; });
  for (const double bad : {nan, -0.1, 1.1}) refused([&](auto& o) { o.tolerance = bad; });
  for (const double bad : {nan, -1., 1. / 0.}) refused([&](auto& o) { o.psnr = bad; });
  for (const double bad : {nan, 0., 65.})
    refused([&](auto& o) { o.radius = static_cast<float>(bad); });
}

}  // namespace
}  // namespace ps
