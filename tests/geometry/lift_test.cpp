// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/lift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "tests/support/box_world.h"
#include "tests/support/same_points.h"

namespace ps {
namespace {

View flat_view(int width, int height, float depth) {
  View view;
  view.intrinsics = {width, height, 100, 100, (width - 1) / 2.0, (height - 1) / 2.0};
  view.color = Image(height, width, cv::Vec3f(0.25f, 0.5f, 0.75f));
  view.depth = Depth(height, width, depth);
  return view;
}

TEST(Lift, then_projecting_returns_each_pixel) {
  for (const auto& [width, height] : {std::pair(64, 48), std::pair(33, 97), std::pair(1, 1)}) {
    const Intrinsics k{width, height, 71.3, 69.9, 0.45 * width, 0.55 * height};
    const View view = box_world_view(k, pose_at(0.5, 0.1, -2, 0.3, 0.2));
    LiftOptions keep_all;
    keep_all.edge_footprints = 0;
    const Cloud cloud = lift(view, 3, Origin::observed, keep_all);
    ASSERT_EQ(cloud.size(), view.depth.total());
    const Pose cam_from_world = view.world_from_cam.inverse();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
      const Eigen::Vector3d p = cam_from_world * cloud[i].getVector3fMap().cast<double>();
      EXPECT_NEAR(k.project(p).x(), x, 1e-3);
      EXPECT_NEAR(k.project(p).y(), y, 1e-3);
      EXPECT_NEAR(p.z(), view.depth(y, x), 1e-5);
      EXPECT_EQ(cloud[i].view, 3);
      EXPECT_EQ(cloud[i].origin, 0);
      EXPECT_EQ(cloud[i].r, std::lround(view.color(y, x)[0] * 255));
      EXPECT_NEAR(cloud[i].footprint, view.depth(y, x) / std::sqrt(71.3 * 69.9), 1e-6);
    }
  }
}

TEST(Lift, unknown_depth_is_skipped) {
  View view = flat_view(5, 3, 2);
  view.depth(0, 0) = 0;
  view.depth(0, 1) = -1;
  view.depth(0, 2) = std::numeric_limits<float>::quiet_NaN();
  view.depth(0, 3) = std::numeric_limits<float>::infinity();
  EXPECT_EQ(lift(view).size(), 11u);
  LiftOptions range;
  range.min_depth = 2.1;
  EXPECT_EQ(lift(view, 0, Origin::observed, range).size(), 0u);
  range.min_depth = 0;
  range.max_depth = 1.9;
  EXPECT_EQ(lift(view, 0, Origin::observed, range).size(), 0u);
}

TEST(Lift, a_pixel_hanging_between_two_surfaces_is_dropped) {
  View view = flat_view(9, 9, 1);
  view.depth.colRange(5, 9) = 3;
  view.depth.col(4) = 2;  // the flying column
  const Mask usable = liftable(view.depth, view.intrinsics);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) EXPECT_EQ(usable(y, x), x != 4) << x << " " << y;
  }
}

TEST(Lift, an_estimated_slope_is_not_steeper_for_a_longer_lens) {
  View slope = flat_view(60, 50, 1);
  for (int x = 0; x < 60; ++x) slope.depth.col(x) = std::exp(0.05f * static_cast<float>(x));
  LiftOptions options;
  const auto kept = [&](double focal, bool estimated) {
    slope.intrinsics.fx = slope.intrinsics.fy = focal;
    options.estimated = estimated;
    return cv::countNonZero(liftable(slope.depth, slope.intrinsics, options));
  };
  for (const double focal : {30., 60., 99.}) EXPECT_EQ(kept(focal, true), 60 * 50);
  for (const double focal : {101., 200., 1000., 10000.}) EXPECT_EQ(kept(focal, true), 60 * 50);
  EXPECT_LT(kept(1000, false), 60 * 50 / 10);
}

TEST(Lift, estimated_depth_through_a_usual_lens_is_lifted_as_measured_depth_is) {
  const Intrinsics k = intrinsics_from_fov(96, 64, 60);
  View view = box_world_view(k, pose_at(0.5, 0.1, -2, 0.3, 0.2));
  view.depth.col(40) = 0.5f * (view.depth.col(39) + view.depth.col(41)) + 0.3f;
  for (int x = 50; x < 96; ++x) view.depth.col(x) *= std::exp(0.15f * static_cast<float>(x - 50));
  LiftOptions estimated;
  estimated.estimated = true;
  const Mask measured = liftable(view.depth, k);
  EXPECT_LT(cv::countNonZero(measured), 96 * 64);
  EXPECT_EQ(cv::countNonZero(measured != liftable(view.depth, k, estimated)), 0);
}

TEST(Lift, a_clean_step_and_a_steep_slope_keep_all_pixels) {
  View step = flat_view(9, 9, 1);
  step.depth.colRange(5, 9) = 3;
  EXPECT_EQ(cv::countNonZero(liftable(step.depth, step.intrinsics)), 81);
  View slope = flat_view(9, 9, 1);
  for (int x = 0; x < 9; ++x)
    slope.depth.col(x) = 1 + 0.05f * static_cast<float>(x);  // 5 footprints
  EXPECT_EQ(cv::countNonZero(liftable(slope.depth, slope.intrinsics)), 81);
}

TEST(Lift, the_edge_threshold_follows_the_footprint) {
  // The same jump in metres is an edge when near and a slope when ten times as far away.
  for (const auto& [depth, kept] : {std::pair(1.0f, false), std::pair(10.0f, true)}) {
    View view = flat_view(9, 9, depth);
    view.depth.col(4) = depth + 0.2f;
    view.depth.colRange(5, 9) = depth + 0.4f;
    EXPECT_EQ(liftable(view.depth, view.intrinsics)(4, 4) != 0, kept) << depth;
  }
}

TEST(Lift, bytes_do_not_depend_on_threads) {
  const View view = box_world_view({200, 150, 150, 150, 99, 74}, pose_at(0, 0, -2, 0));
  set_threads(1);
  const Cloud one = lift(view);
  set_threads(4);
  const Cloud four = lift(view);
  set_threads(0);
  EXPECT_TRUE(same_points(one, four));
}

TEST(Lift, sizes_that_differ_are_refused) {
  View view = flat_view(5, 3, 2);
  EXPECT_THROW(lift(view, Mask(4, 4, 1), 0, Origin::observed), Error);
  view.color.create(2, 2);
  EXPECT_THROW(check(view, "here"), Error);
}

}  // namespace
}  // namespace ps
