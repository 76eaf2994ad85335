// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/closed_splat.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libps/core/error.h"
#include "libps/geometry/lift.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

const Intrinsics kCamera{80, 60, 64, 64, 39.5, 29.5};

SplatOptions of_radius(float radius) {
  SplatOptions options;
  options.radius = radius;
  options.renormalise = true;
  return options;
}

Cloud every(const Cloud& cloud, std::size_t step) {
  Cloud some;
  for (std::size_t i = 0; i < cloud.size(); i += step) some.push_back(cloud[i]);
  return some;
}

TEST(ClosedSplat, shows_what_the_narrow_splat_shows_and_closes_the_rest) {
  const View view = box_world_view(kCamera, pose_at(0, 0, -2, 0.1));
  const Cloud sparse = every(lift(view), 23);
  SplatOptions narrow = of_radius(1.5f);
  narrow.thickness = .05f;
  const Splat plain = splat(sparse, kCamera, view.world_from_cam, narrow);
  ASSERT_LT(cv::countNonZero(plain.hit), 0.5 * static_cast<double>(plain.hit.total()));
  const Splat closed = closed_splat(sparse, kCamera, view.world_from_cam, of_radius(32), 1.5f);
  EXPECT_EQ(cv::countNonZero(closed.hit), static_cast<int>(closed.hit.total()));
  EXPECT_EQ(cv::countNonZero(closed.missing), 0);
  int changed = 0;
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      EXPECT_GT(closed.expected_depth(y, x), 0);
      if (!plain.hit(y, x)) continue;
      // What is changed was seen through a gap.
      if (closed.color(y, x) != plain.color(y, x)) {
        ++changed;
        EXPECT_LT(closed.first_depth(y, x), plain.first_depth(y, x));
      } else {
        EXPECT_EQ(closed.first_depth(y, x), plain.first_depth(y, x));
      }
    }
  }
  EXPECT_LT(changed, cv::countNonZero(plain.hit) / 20);
}

/// A wall of points so many pixels apart, as many metres away; of one colour.
Cloud wall(double z, double apart, std::uint8_t red) {
  Cloud cloud;
  for (double v = 0; v < kCamera.height; v += apart) {
    for (double u = 0; u < kCamera.width; u += apart) {
      Point p;
      p.x = static_cast<float>((u - kCamera.cx) / kCamera.fx * z);
      p.y = static_cast<float>((v - kCamera.cy) / kCamera.fy * z);
      p.z = static_cast<float>(z);
      p.r = red;
      cloud.push_back(p);
    }
  }
  return cloud;
}

TEST(ClosedSplat, nothing_is_seen_through_a_surface_of_sparse_points) {
  const Cloud cloud = wall(1, 3, 255) + wall(2, 1, 0);
  const Splat narrow = splat(cloud, kCamera, Pose::Identity(), of_radius(1));
  EXPECT_GT(cv::countNonZero(narrow.first_depth > 1.5), 1000);
  const Splat closed = closed_splat(cloud, kCamera, Pose::Identity(), of_radius(4));
  EXPECT_EQ(cv::countNonZero(closed.first_depth > 1.5), 0);
  EXPECT_GT(closed.color(30, 40)[0], .95f);
}

TEST(ClosedSplat, nothing_shines_through_a_board_however_its_points_fall) {
  for (const double apart : {.72, 1., 1.41, 2., 2.7}) {
    Cloud board = wall(1, apart, 255);
    for (const bool told : {false, true}) {
      if (told) {
        for (Point& p : board) p.footprint = static_cast<float>(apart / kCamera.fx);
      }
      const Cloud cloud = board + wall(2, .7, 0);
      for (const double turn : {0., .02}) {
        const Splat closed = closed_splat(cloud, kCamera, pose_at(0, 0, 0, turn), of_radius(4));
        const cv::Rect inner(8, 8, 64, 44);
        EXPECT_EQ(cv::countNonZero(closed.expected_depth(inner) > 1.1), 0) << apart << told << turn;
        double least = 1;
        std::vector<cv::Mat> channels;
        cv::split(closed.color(inner), channels);
        cv::minMaxLoc(channels[0], &least);
        EXPECT_GT(least, .99) << apart << told << turn;
      }
    }
  }
}

TEST(ClosedSplat, surfaces_do_not_grow_and_slits_between_them_stay_open) {
  Cloud cloud;
  for (const Point& p : wall(1, 1, 255)) {
    if (p.x < -.05f || (p.x > 0 && p.x < .3f)) cloud.push_back(p);
  }
  const Mask narrow = splat(cloud, kCamera, Pose::Identity(), of_radius(1)).hit;
  const Mask wide = splat(cloud, kCamera, Pose::Identity(), of_radius(4)).hit;
  Cloud all = cloud + wall(2, 1, 0);
  const Splat closed = closed_splat(all, kCamera, Pose::Identity(), of_radius(4));
  const Mask near = closed.first_depth < 1.5;
  EXPECT_EQ(cv::countNonZero((near != 0) != (narrow != 0)), 0);
  EXPECT_GT(cv::countNonZero(wide), cv::countNonZero(narrow) + 3 * kCamera.height);
}

TEST(ClosedSplat, is_the_splat_itself_where_all_splats_are_alike) {
  const View view = box_world_view(kCamera, pose_at(0, 0, -2, 0.1));
  const Cloud cloud = every(lift(view), 23);
  const Splat plain = splat(cloud, kCamera, view.world_from_cam, of_radius(1.5f));
  for (const float finest : {1.5f, 4.f}) {
    const Splat closed = closed_splat(cloud, kCamera, view.world_from_cam, of_radius(1.5f), finest);
    EXPECT_EQ(cv::norm(plain.color, closed.color, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(plain.missing, closed.missing, cv::NORM_INF), 0);
  }
}

TEST(ClosedSplat, of_no_points_is_empty_and_unsound_radii_are_refused) {
  const Cloud none;
  const Splat picture = closed_splat(none, kCamera, Pose::Identity(), of_radius(64));
  EXPECT_EQ(cv::countNonZero(picture.hit), 0);
  EXPECT_EQ(cv::countNonZero(picture.missing == 0), 0);
  for (const float radius : {65.f, 0.f, std::nanf("")}) {
    EXPECT_THROW(closed_splat(none, kCamera, Pose::Identity(), of_radius(radius)), Error);
  }
  for (const float finest : {0.f, -1.f, std::nanf("")}) {
    EXPECT_THROW(closed_splat(none, kCamera, Pose::Identity(), of_radius(4), finest), Error);
  }
}

}  // namespace
}  // namespace ps
