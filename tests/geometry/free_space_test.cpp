// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/free_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool known(float depth) { return depth > 0 && std::isfinite(depth); }

/// The obvious way, for one pixel and one observed view.
bool before_what_was_seen(const View& view, int x, int y, const View& observed,
                          const FreeSpaceOptions& options) {
  const Eigen::Vector3d in_world =
      view.world_from_cam * view.intrinsics.lift(x, y, view.depth(y, x));
  const Eigen::Vector3d p = observed.world_from_cam.inverse() * in_world;
  if (p.z() <= 0) return false;
  const Eigen::Vector2d at = observed.intrinsics.project(p);
  const double u = std::floor(at.x() + 0.5), v = std::floor(at.y() + 0.5);
  const cv::Size size = observed.depth.size();
  if (u < 0 || v < 0 || u >= size.width || v >= size.height) return false;
  double surface = std::numeric_limits<double>::infinity();
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      if (std::abs(row - v) > 1 || std::abs(column - u) > 1) continue;
      const float d = observed.depth(row, column);
      if (known(d)) surface = std::min<double>(surface, d);
    }
  }
  const double footprint = surface * observed.intrinsics.footprint_per_metre();
  return std::isfinite(surface) && p.z() < surface - options.tolerance_relative * surface -
                                               options.tolerance_footprints * footprint;
}

/// A view of the little world whose depths are wrong by up to a third, and now and then unknown.
View wrong_view(const Intrinsics& k, const Pose& pose, std::uint64_t seed) {
  View view = box_world_view(k, pose);
  for (int y = 0; y < k.height; ++y) {
    for (int x = 0; x < k.width; ++x) {
      const auto at = [&](std::uint32_t what) {
        return random_unit(seed,
                           {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), what, 0});
      };
      view.depth(y, x) *= static_cast<float>(0.67 + 0.66 * at(0));
      if (at(1) < 0.05) view.depth(y, x) = at(2) < 0.5 ? 0 : kNan;
    }
  }
  return view;
}

View wall(float depth, int side = 21) {
  View view;
  view.intrinsics = {side, side, 100, 100, (side - 1) / 2.0, (side - 1) / 2.0};
  view.depth = Depth(side, side, depth);
  return view;
}

Mask all_of(const View& view) { return Mask(view.depth.size(), 1); }

TEST(FreeSpace, is_that_of_brute_force) {
  int found = 0, asked = 0;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const auto number = [&](std::uint32_t what) {
      return random_unit(7, {seed, what, 0, 0}) - 0.5;
    };
    const auto pose = [&](std::uint32_t n) {
      return pose_at(number(n), 0.5 * number(n + 1), -2 + number(n + 2), number(n + 3),
                     number(n + 4));
    };
    const View view = wrong_view({37, 29, 30, 31, 18, 13}, pose(0), seed);
    const std::vector<View> observed = {wrong_view({40, 30, 33, 33, 20, 15}, pose(10), seed + 50),
                                        box_world_view({25, 35, 20, 21, 12, 17}, pose(20))};
    Mask pixels(view.depth.size());
    for (int i = 0; i < static_cast<int>(pixels.total()); ++i)
      pixels(i / pixels.cols, i % pixels.cols) = i % 5 > 0;
    FreeSpaceOptions options;
    if (seed % 2 == 1) options = {0.05, 0};
    const Mask mask = in_free_space(view, pixels, observed, options);
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        const bool expected = pixels(y, x) && known(view.depth(y, x)) &&
                              (before_what_was_seen(view, x, y, observed[0], options) ||
                               before_what_was_seen(view, x, y, observed[1], options));
        ASSERT_EQ(mask(y, x), expected) << seed << ": " << x << " " << y;
        found += expected;
        asked += pixels(y, x);
      }
    }
  }
  EXPECT_GT(found, asked / 10);
  EXPECT_LT(found, asked * 9 / 10);
}

TEST(FreeSpace, nothing_that_is_where_it_was_seen_or_behind_it_is_in_free_space) {
  const Intrinsics k{96, 72, 80, 80, 47.5, 35.5};
  const View seen = box_world_view(k, pose_at(0, 0, -2, 0));
  EXPECT_EQ(cv::countNonZero(in_free_space(seen, all_of(seen), {seen})), 0);
  View behind = seen;
  behind.depth = Depth(seen.depth * 1.2f);
  EXPECT_EQ(cv::countNonZero(in_free_space(behind, all_of(behind), {seen})), 0);
  const View beside = box_world_view(k, pose_at(0.4, 0.1, -1.8, 0.3));
  EXPECT_EQ(cv::countNonZero(in_free_space(beside, all_of(beside), {seen})), 0);
}

TEST(FreeSpace, what_floats_before_a_wall_is_in_it_beyond_the_tolerance) {
  const View seen = wall(2);  // tolerance: 2 m * (1 % + 2 / 100)
  for (const auto& [depth, expected] : {std::pair(1.9f, true), std::pair(1.93f, true),
                                        std::pair(1.95f, false), std::pair(2.1f, false)}) {
    const View view = wall(depth);
    EXPECT_EQ(in_free_space(view, all_of(view), {seen})(10, 10) != 0, expected) << depth;
  }
}

TEST(FreeSpace, a_depth_edge_a_pixel_off_condemns_nothing) {
  View seen = wall(3);
  seen.depth.colRange(0, 10) = 1;
  View view = seen;
  view.depth = seen.depth.clone();
  view.depth.col(10) = 1;
  const Mask mask = in_free_space(view, all_of(view), {seen});
  EXPECT_EQ(cv::countNonZero(mask), 0);
  view.depth.col(11) = 1;
  EXPECT_EQ(cv::countNonZero(in_free_space(view, all_of(view), {seen}).col(11)), 21);
}

TEST(FreeSpace, views_that_do_not_see_the_point_say_nothing) {
  const View view = wall(1);
  View blind = wall(kNan), away = wall(2), aside = wall(2);
  away.world_from_cam = pose_at(0, 0, 0, M_PI);
  aside.world_from_cam = pose_at(50, 0, 0, 0);
  EXPECT_EQ(cv::countNonZero(in_free_space(view, all_of(view), {blind, away, aside})), 0);
  EXPECT_EQ(cv::countNonZero(in_free_space(view, all_of(view), {})), 0);
  EXPECT_EQ(cv::countNonZero(in_free_space(view, all_of(view), {blind, wall(2)})), 21 * 21);
}

TEST(FreeSpace, bytes_do_not_depend_on_threads) {
  const View view = wrong_view({60, 50, 50, 50, 30, 25}, pose_at(0.2, 0, -2, 0.2), 1);
  const View seen = box_world_view({60, 50, 50, 50, 30, 25}, pose_at(0, 0, -2, 0));
  set_threads(1);
  const Mask one = in_free_space(view, all_of(view), {seen});
  set_threads(4);
  const Mask four = in_free_space(view, all_of(view), {seen});
  set_threads(0);
  EXPECT_GT(cv::countNonZero(one), 0);
  EXPECT_EQ(cv::countNonZero(one != four), 0);
}

TEST(FreeSpace, a_single_pixel_will_do) {
  EXPECT_EQ(in_free_space(wall(1, 1), Mask(1, 1, 1), {wall(2, 1)})(0, 0), 1);
  EXPECT_EQ(in_free_space(wall(0, 1), Mask(1, 1, 1), {wall(2, 1)})(0, 0), 0);
  EXPECT_EQ(in_free_space(wall(1, 1), Mask(1, 1, std::uint8_t{0}), {wall(2, 1)})(0, 0), 0);
}

TEST(FreeSpace, what_is_unsound_is_refused) {
  const View view = wall(1);
  View small = wall(2);
  small.depth = Depth(3, 3, 1.f);
  View bent = wall(2);
  bent.world_from_cam.linear() *= 2;
  EXPECT_THROW(in_free_space(view, Mask(3, 3, 1), {}), Error);
  EXPECT_THROW(in_free_space(view, all_of(view), {small}), Error);
  EXPECT_THROW(in_free_space(small, Mask(3, 3, 1), {}), Error);
  EXPECT_THROW(in_free_space(view, all_of(view), {bent}), Error);
  EXPECT_THROW(in_free_space(view, all_of(view), {}, {-1, 2}), Error);
  EXPECT_THROW(in_free_space(view, all_of(view), {}, {0.01, NAN}), Error);
}

}  // namespace
}  // namespace ps
