// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/closed_splat.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"
#include "libps/geometry/lift.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

const Intrinsics kCamera{80, 60, 64, 64, 39.5, 29.5};

SplatOptions narrow() {
  SplatOptions options;
  options.radius = 1.5f;
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
  const Splat plain = splat(sparse, kCamera, view.world_from_cam, narrow());
  ASSERT_LT(cv::countNonZero(plain.hit), 0.5 * static_cast<double>(plain.hit.total()));
  const Splat closed = closed_splat(sparse, kCamera, view.world_from_cam, narrow(), 32);
  EXPECT_EQ(cv::countNonZero(closed.hit), static_cast<int>(closed.hit.total()));
  EXPECT_EQ(cv::countNonZero(closed.missing), 0);
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      EXPECT_GT(closed.expected_depth(y, x), 0);
      if (!plain.hit(y, x)) continue;
      EXPECT_EQ(closed.color(y, x), plain.color(y, x));
      EXPECT_EQ(closed.first_depth(y, x), plain.first_depth(y, x));
    }
  }
}

TEST(ClosedSplat, is_the_splat_itself_where_nothing_is_missing_or_no_more_is_allowed) {
  const View view = box_world_view(kCamera, pose_at(0, 0, -2, 0.1));
  for (const std::size_t step : {std::size_t{1}, std::size_t{23}}) {
    const Cloud cloud = every(lift(view), step);
    const Splat plain = splat(cloud, kCamera, view.world_from_cam, narrow());
    const Splat closed =
        closed_splat(cloud, kCamera, view.world_from_cam, narrow(), step == 1 ? 8.f : 1.5f);
    EXPECT_EQ(cv::norm(plain.color, closed.color, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(plain.missing, closed.missing, cv::NORM_INF), 0);
  }
}

TEST(ClosedSplat, of_no_points_is_empty_and_too_wide_is_refused) {
  const Cloud none;
  const Splat picture = closed_splat(none, kCamera, Pose::Identity(), narrow(), 64);
  EXPECT_EQ(cv::countNonZero(picture.hit), 0);
  EXPECT_THROW(closed_splat(none, kCamera, Pose::Identity(), narrow(), 65), Error);
}

}  // namespace
}  // namespace ps
