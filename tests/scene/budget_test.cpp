// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "libps/eval/image_metrics.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/splat.h"
#include "tests/support/box_world.h"
#include "tests/support/same_points.h"

namespace ps {
namespace {

const Intrinsics kCamera{160, 120, 120, 120, 79.5, 59.5};
const std::vector<PlannedView> kFront = {{kCamera, Pose::Identity()}};

using ColorOf = std::function<cv::Vec3f(int x, int y)>;
using DepthOf = std::function<float(int x, int y)>;

/// One point for each pixel of the camera at the origin.
Cloud picture_cloud(const ColorOf& color, const DepthOf& depth, Origin origin = Origin::observed) {
  View view;
  view.intrinsics = kCamera;
  view.color.create(kCamera.height, kCamera.width);
  view.depth.create(kCamera.height, kCamera.width);
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      view.color(y, x) = color(x, y);
      view.depth(y, x) = depth(x, y);
    }
  }
  LiftOptions keep_all;
  keep_all.edge_footprints = 0;
  return lift(view, 0, origin, keep_all);
}

float two_metres(int, int) { return 2; }

cv::Vec3f plain(int, int) { return {0.2f, 0.6f, 0.4f}; }

cv::Vec3f smooth(int x, int y) {
  const auto u = static_cast<float>(x), v = static_cast<float>(y);
  return {0.2f + 0.003f * u, 0.5f + 0.1f * std::sin(0.03f * v), 0.7f - 0.002f * u};
}

cv::Vec3f noise(int x, int y) {
  const auto number = [&](std::uint32_t channel) {
    return static_cast<float>(
        random_unit(7, {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), channel, 0}));
  };
  return {number(0), number(1), number(2)};
}

cv::Vec3f chequers(int x, int y) {
  return (x / 3 + y / 3) % 2 == 0 ? cv::Vec3f(0.1f, 0.1f, 0.1f) : cv::Vec3f(0.9f, 0.9f, 0.9f);
}

/// Plain to the left, chequered to the right.
cv::Vec3f half_and_half(int x, int y) { return x < 80 ? smooth(x, y) : chequers(x, y); }

Splat draw(const Cloud& cloud, const Pose& pose = Pose::Identity()) {
  SplatOptions options;
  options.renormalise = true;
  return splat(cloud, kCamera, pose, options);
}

/// dB, where the whole cloud hits.
double psnr_of(const Cloud& thin, const Cloud& whole, const Pose& pose = Pose::Identity()) {
  const Splat before = draw(whole, pose);
  return psnr(draw(thin, pose).color, before.color, before.hit);
}

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
  for (const ColorOf& color : {ColorOf(noise), ColorOf(chequers)}) {
    const Cloud whole = picture_cloud(color, two_metres);
    const Cloud thin = thinned(whole, kFront);
    EXPECT_GT(thin.size(), whole.size() * 9 / 10);
    EXPECT_GT(psnr_of(thin, whole), 40);
  }
}

TEST(Budget, what_is_plain_is_thinned_beside_texture_and_up_to_it) {
  const Cloud whole = picture_cloud(half_and_half, two_metres);
  const Cloud thin = thinned(whole, kFront);
  std::size_t plain_side = 0, textured_side = 0;
  for (const Point& p : thin) ++(p.x < 0 ? plain_side : textured_side);
  EXPECT_LT(plain_side, whole.size() / 2 / 3);
  EXPECT_GT(textured_side, whole.size() / 2 * 9 / 10);
  EXPECT_GT(psnr_of(thin, whole), 40);
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
  const Cloud thin = thinned(whole, {{kCamera, pose_at(0, 0, -2, 0.3)}});
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
  EXPECT_NEAR(area(thinned(whole, kFront)) / area(whole), 1, 0.05);
  // Of points on top of each other only one counts.
  Cloud twice = whole;
  twice += whole;
  EXPECT_NEAR(area(thinned(twice, kFront)) / area(whole), 1.5, 0.5);
}

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
  options.psnr = 26;
  const std::size_t finer = thinned(whole, coarse, options, &report).size();
  EXPECT_GE(report.psnr, 26);
  EXPECT_LT(report.pixels, 0.5);
  EXPECT_GT(finer, usual);
  EXPECT_LT(finer, whole.size());
  options.points = 2000;
  EXPECT_LE(thinned(whole, coarse, options, &report).size(), 2000u);
  EXPECT_LT(report.psnr, 26);
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

TEST(Budget, bytes_do_not_depend_on_threads) {
  Cloud whole;
  std::vector<PlannedView> views;
  for (const Pose& pose : box_world_walk(4)) {
    whole += lift(box_world_view(kCamera, pose));
    views.push_back({kCamera, pose});
  }
  BudgetOptions targets;
  targets.psnr = 38;
  targets.points = whole.size() / 20;
  for (const BudgetOptions& options : {BudgetOptions(), targets}) {
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
