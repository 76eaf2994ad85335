// SPDX-License-Identifier: BSD-3-Clause
// What the budget thins and what it keeps.
#include "libps/scene/budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "tests/scene/budget_pictures.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

std::size_t pixels_lost(const Cloud& thin, const Cloud& whole) {
  return cv::countNonZero(draw(whole).hit & (draw(thin).hit == 0));
}

std::size_t count_of(const Cloud& cloud, Origin origin) {
  return std::count_if(cloud.begin(), cloud.end(), [&](const Point& p) {
    return p.origin == static_cast<std::uint8_t>(origin);
  });
}

TEST(Budget, a_smooth_plane_is_thinned_without_holes) {
  const Cloud whole = picture_cloud(smooth, two_metres);
  BudgetReport report;
  const Cloud thin = thinned(whole, kFront, {}, &report);
  EXPECT_LT(thin.size(), whole.size() / 4);
  EXPECT_EQ(report.points, thin.size());
  EXPECT_EQ(report.merged, whole.size() - thin.size());
  EXPECT_EQ(pixels_lost(thin, whole), 0u);
  EXPECT_GT(psnr_of(thin, whole), 40);
}

TEST(Budget, a_slanted_plane_is_thinned_without_holes) {
  const auto slanted = [](int x, int) { return 2 / (1 + 0.004f * static_cast<float>(x - 80)); };
  const Cloud whole = picture_cloud(smooth, slanted);
  const Cloud thin = thinned(whole, kFront);
  EXPECT_LT(thin.size(), whole.size() / 4);
  EXPECT_EQ(pixels_lost(thin, whole), 0u);
  EXPECT_GT(psnr_of(thin, whole), 40);
}

TEST(Budget, texture_keeps_its_points) {
  const Cloud noisy = picture_cloud(noise, two_metres);
  EXPECT_EQ(thinned(noisy, kFront).size(), noisy.size());
  // Some squares of three pixels become one point, whose splat reaches a little beyond: so wide
  // that noisy surfaces are smooth. (Narrower ones cost real frames half a decibel.)
  const Cloud whole = picture_cloud(chequers, two_metres);
  const Cloud thin = thinned(whole, kFront);
  EXPECT_GT(thin.size(), whole.size() * 97 / 100);
  EXPECT_GT(psnr_of(thin, whole), 27);
}

TEST(Budget, what_is_plain_is_thinned_beside_texture_and_up_to_it) {
  const Cloud whole = picture_cloud(half_and_half, two_metres);
  const Cloud thin = thinned(whole, kFront);
  std::size_t plain_side = 0, textured_side = 0;
  for (const Point& p : thin) ++(p.x < 0 ? plain_side : textured_side);
  EXPECT_LT(plain_side, whole.size() / 2 / 3);
  EXPECT_GT(textured_side, whole.size() / 2 * 97 / 100);
  EXPECT_GT(psnr_of(thin, whole), 30);
}

TEST(Budget, noise_finer_than_half_a_pixel_is_merged) {
  // The planned camera is an eighth as sharp as the one that saw the points.
  const Cloud whole = picture_cloud(noise, two_metres);
  const std::vector<PlannedView> coarse = {{resized(kCamera, 20, 15), Pose::Identity()}};
  const Cloud thin = thinned(whole, coarse);
  const double pixel = 2.0 / 15;
  EXPECT_LT(thin.size(), whole.size() / 8);
  for (std::size_t i = 0; i < thin.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto apart = (thin[i].getVector3fMap() - thin[j].getVector3fMap()).norm();
      ASSERT_GE(apart, 0.4999 * pixel);
    }
  }
  // One that comes near needs them again.
  std::vector<PlannedView> views = coarse;
  views.push_back(kFront.front());
  EXPECT_GT(thinned(whole, views).size(), whole.size() * 9 / 10);
}

TEST(Budget, surfaces_at_different_depth_are_never_mixed) {
  const cv::Vec3f red(1, 0, 0), blue(0, 0, 1);
  const auto in_front = [](int x, int y) { return x > 50 && x < 110 && y > 30 && y < 90; };
  const Cloud whole = picture_cloud([&](int x, int y) { return in_front(x, y) ? red : blue; },
                                    [&](int x, int y) { return in_front(x, y) ? 2.f : 2.5f; });
  const Cloud thin = thinned(whole, kFront);
  EXPECT_LT(thin.size(), whole.size() / 4);
  for (const Point& p : thin) {
    const bool near = p.z < 2.25f;
    EXPECT_EQ(p.r, near ? 255 : 0);
    EXPECT_EQ(p.b, near ? 0 : 255);
  }
  EXPECT_EQ(pixels_lost(thin, whole), 0u);
  // The outline stays where it was, to a pixel, and to where it hides what is behind.
  const Splat before = draw(whole), after = draw(thin);
  const Mask was_near = before.first_depth < 2.25, is_near = after.first_depth < 2.25;
  EXPECT_LT(cv::countNonZero(was_near != is_near), 240 / 4);
  EXPECT_GT(psnr_of(thin, whole), 30);
}

TEST(Budget, sheets_two_pixels_apart_and_more_keep_their_colours) {
  for (const float apart : {2.f, 2.5f, 3.f, 3.5f}) {
    Cloud whole = picture_cloud([](int, int) { return cv::Vec3f(1, 0, 0); }, two_metres);
    whole += picture_cloud([](int, int) { return cv::Vec3f(0, 0, 1); },
                           [&](int, int) { return 2 + apart * 2 / 120; });
    for (const Point& p : thinned(whole, kFront)) {
      EXPECT_EQ(p.r, p.z < 2.01f ? 255 : 0);
      EXPECT_EQ(p.b, p.z < 2.01f ? 0 : 255);
    }
  }
}

TEST(Budget, points_that_stay_do_not_move) {
  const Cloud whole = lift(box_world_view(kCamera, pose_at(0, 0, -2, 0.3)));
  std::set<std::array<float, 3>> places;
  for (const Point& p : whole) places.insert({p.x, p.y, p.z});
  BudgetOptions options;
  options.tolerance = 0.03;
  const Cloud thin = thinned(whole, {{kCamera, pose_at(0, 0, -2, 0.3)}}, options);
  EXPECT_LT(thin.size(), whole.size() * 3 / 4);
  for (const Point& p : thin) EXPECT_EQ(places.count({p.x, p.y, p.z}), 1u);
}

TEST(Budget, observed_and_outpainted_points_are_never_merged) {
  Cloud whole = picture_cloud([](int, int) { return cv::Vec3f(1, 0, 0); }, two_metres);
  whole +=
      picture_cloud([](int, int) { return cv::Vec3f(0, 0, 1); }, two_metres, Origin::outpainted);
  const Cloud thin = thinned(whole, kFront);
  EXPECT_LT(thin.size(), whole.size() / 4);
  EXPECT_GT(count_of(thin, Origin::observed), thin.size() / 3);
  EXPECT_GT(count_of(thin, Origin::outpainted), thin.size() / 3);
  for (const Point& p : thin) {
    EXPECT_EQ(p.r, p.origin == 0 ? 255 : 0);
    EXPECT_EQ(p.b, p.origin == 0 ? 0 : 255);
  }
}

TEST(Budget, footprints_cover_what_was_covered) {
  const Cloud whole = picture_cloud(plain, two_metres);
  const auto area = [](const Cloud& cloud) {
    double sum = 0;
    for (const Point& p : cloud) sum += p.footprint * p.footprint;
    return sum;
  };
  // They overlap, so that what is spread unevenly leaves no gaps.
  EXPECT_NEAR(area(thinned(whole, kFront)) / area(whole), 2.1, 0.2);
  // Points on top of each other do not count in full.
  Cloud twice = whole;
  twice += whole;
  EXPECT_LT(area(thinned(twice, kFront)) / area(thinned(whole, kFront)), 1.75);
}

}  // namespace
}  // namespace ps
