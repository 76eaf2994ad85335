// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/depth_alignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "tests/geometry/alignment_case.h"

namespace ps {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Depth depth_where(cv::Size size, const std::function<double(int x, int y)>& depth) {
  Depth image(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image(y, x) = static_cast<float>(depth(x, y));
  }
  return image;
}

/// A wall that goes back to the right; planes are linear in 1/z.
Depth slanted_wall(cv::Size size) {
  return depth_where(
      size, [&](int x, int y) { return 1 / (0.5 - 0.3 * x / size.width + 0.1 * y / size.height); });
}

double number(std::uint32_t x, std::uint32_t y, std::uint32_t what) {
  return random_unit(3, {x, y, what, 0});
}

/// The greatest relative difference.
double worst(const Depth& depth, const Depth& truth, const Mask& where) {
  double most = 0;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      if (where(y, x)) most = std::max<double>(most, std::fabs(depth(y, x) / truth(y, x) - 1));
    }
  }
  return most;
}

void expect_all_positive(const Depth& depth) {
  for (const float d : depth) ASSERT_TRUE(d > 0 && std::isfinite(d)) << d;
}

AlignedDepth align(const AlignmentCase& c, const DepthAlignmentOptions& options = {}) {
  return align_depth(c.estimate, c.cloud, c.visible, c.missing, options);
}

AlignmentCase wall_case(cv::Size size = {96, 64}) {
  return hidden(slanted_wall(size), {0, 0, size.width / 2, size.height});
}

TEST(AlignDepth, a_wall_that_is_a_factor_or_a_power_off_becomes_the_exact_wall) {
  for (const cv::Size size : {cv::Size(96, 64), cv::Size(61, 90), cv::Size(24, 24)}) {
    for (const double exponent : {0.55, 0.8, 1.0, 1.4, 1.9}) {
      for (const double scale : {0.01, 0.5, 1.0, 300.0}) {
        AlignmentCase c = wall_case(size);
        c.estimate = depth_where(
            size, [&](int x, int y) { return std::pow(c.truth(y, x) / scale, 1 / exponent); });
        const AlignedDepth aligned = align(c);
        EXPECT_TRUE(aligned.agreed) << aligned.why;
        EXPECT_NEAR(aligned.exponent, exponent, 1e-3);
        EXPECT_NEAR(aligned.scale / scale, 1, 2e-3);
        EXPECT_LT(aligned.residual, 1e-5);
        EXPECT_LT(worst(aligned.depth, c.truth, Mask(size, 1)), 1e-3) << size << exponent << scale;
      }
    }
  }
}

TEST(AlignDepth, a_wall_straight_ahead_leaves_the_exponent_alone) {
  AlignmentCase c = hidden(Depth(40, 60, 3.f), {0, 0, 30, 40});
  c.estimate = Depth(40, 60, 0.7f);
  const AlignedDepth aligned = align(c);
  EXPECT_TRUE(aligned.agreed);
  EXPECT_EQ(aligned.exponent, 1);
  EXPECT_LT(worst(aligned.depth, c.truth, Mask(40, 60, 1)), 1e-5);
}

TEST(AlignDepth, the_seen_half_of_a_room_leads_to_the_other) {
  double before = 0, after = 0;
  for (int yaw = 0; yaw < 4; ++yaw) {
    AlignmentCase c = box_world_case(yaw);
    c.estimate = distorted(c.truth, {0.6, 1.2, 0.1, 0}, yaw);
    const AlignedDepth aligned = align(c);
    EXPECT_TRUE(aligned.agreed) << aligned.why;
    EXPECT_LT(aligned.seam_step, 0.01) << yaw;
    EXPECT_LT(aligned.seam_step, aligned.seam_step_before) << yaw;
    EXPECT_GT(aligned.seam_step_seen, 0) << yaw;
    EXPECT_NEAR(aligned.seam_step, aligned.seam_step_seen, 0.005) << yaw;  // walls go on
    before += abs_rel(fitted(c, aligned), c);
    after += abs_rel(aligned.depth, c);
  }
  EXPECT_LT(after, 0.75 * before);
}

TEST(AlignDepth, what_a_moved_camera_sees_of_furnished_rooms_is_nearer_to_the_truth) {
  double raw = 0, scaled = 0, fit = 0, after = 0;
  std::vector<double> steps;
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    AlignmentCase c = furnished_case(seed);
    c.estimate = distorted(c.truth, {0.6, 1.2, 0.1, 0.003}, seed);
    const AlignedDepth aligned = align(c);
    EXPECT_TRUE(aligned.agreed) << aligned.why;
    expect_all_positive(aligned.depth);
    raw += abs_rel(c.estimate, c);
    scaled += abs_rel(median_scaled(c), c);
    fit += abs_rel(fitted(c, aligned), c);
    after += abs_rel(aligned.depth, c);
    steps.push_back(aligned.seam_step);
    c.estimate = c.truth;  // things have steps of their own
    EXPECT_LT(steps.back(), 1.3 * align(c).seam_step) << seed;
  }
  std::sort(steps.begin(), steps.end());
  EXPECT_LT(steps[steps.size() / 2], 0.01);
  EXPECT_LT(after, 0.8 * fit);
  EXPECT_LT(fit, scaled);
  EXPECT_LT(scaled, raw);
}

TEST(AlignDepth, thirty_percent_outliers_do_not_move_the_wall) {
  AlignmentCase c = wall_case();
  c.estimate = depth_where(c.truth.size(), [&](int x, int y) {
    const bool outlier = c.visible(y, x) && number(x, y, 0) < 0.3;
    const double factor = outlier ? 0.2 + 5 * number(x, y, 1) : 1;
    return factor * std::pow(c.truth(y, x) / 2, 1 / 1.3);
  });
  const AlignedDepth aligned = align(c);
  EXPECT_TRUE(aligned.agreed) << aligned.why;
  EXPECT_NEAR(aligned.exponent, 1.3, 1e-3);
  EXPECT_LT(worst(aligned.depth, c.truth, c.missing), 5e-3);
}

/// A thing stands before the wall, up to the seam; the camera moved, so what is missing is wall.
AlignmentCase occluded_case() {
  AlignmentCase c = wall_case();
  c.cloud(cv::Rect(20, 16, 28, 32)) = 1;
  c.estimate = distorted(c.truth, {0.6, 1.2, 0, 0}, 0);
  return c;
}

TEST(AlignDepth, a_thing_before_the_wall_is_not_smeared_into_the_hole) {
  const AlignmentCase unseen = occluded_case();  // the estimate knows nothing of the thing
  EXPECT_LT(worst(align(unseen).depth, unseen.truth, unseen.missing), 0.01);

  AlignmentCase blurred = occluded_case();  // its edge lies 3 pixels beside the cloud's
  Depth front(blurred.truth.size(), 1.f);
  const cv::Rect thing(20, 16, 25, 32);
  distorted(front, {0.6, 1.2, 0, 0}, 0)(thing).copyTo(blurred.estimate(thing));
  EXPECT_LT(worst(align(blurred).depth, blurred.truth, blurred.missing), 0.01);
}

/// Two walls, one behind the other; their edge runs across the seam, and lies `off` pixels lower in
/// the estimate, which errs smoothly as well.
AlignmentCase edge_case(int off) {
  const auto walls = [](int edge) {
    return depth_where({384, 256}, [&](int, int y) { return y < edge ? 2.0 : 3.0; });
  };
  AlignmentCase c = hidden(walls(128), {0, 0, 192, 256});
  c.estimate = distorted(walls(128 + off), {0.6, 1, 0.1, 0}, 3);
  return c;
}

TEST(AlignDepth, an_edge_that_is_a_few_pixels_off_hardly_moves_the_walls_beside_it) {
  const AlignmentCase c = edge_case(0);
  Mask walls = c.missing.clone();
  walls.rowRange(120, 140) = 0;
  EXPECT_LT(worst(align(edge_case(2)).depth, align(c).depth, walls), 0.002);
}

TEST(AlignDepth, where_the_two_cannot_agree_the_cloud_goes_on) {
  AlignmentCase c = wall_case();
  c.estimate =
      depth_where(c.truth.size(), [](int x, int y) { return std::exp(4 * number(x, y, 0)); });
  const AlignedDepth noise = align(c);
  EXPECT_FALSE(noise.agreed);
  EXPECT_NE(noise.why.find("median log ratio"), std::string::npos) << noise.why;
  double least = 0, most = 0;
  cv::minMaxLoc(c.cloud, &least, &most, nullptr, nullptr, c.visible);
  for (const float d : noise.depth) EXPECT_TRUE(d > 0.999 * least && d < 1.001 * most) << d;
  EXPECT_LT(noise.seam_step, 0.01);

  c.cloud = Depth(c.cloud.size(), 2.5f);
  EXPECT_LT(worst(align(c).depth, c.cloud, c.missing), 1e-5);  // exact on what is constant

  c = wall_case();  // too flat: an exponent of 3
  c.estimate =
      depth_where(c.truth.size(), [&](int x, int y) { return std::pow(c.truth(y, x), 1 / 3.0); });
  const AlignedDepth flat = align(c);
  EXPECT_TRUE(flat.agreed);
  EXPECT_EQ(flat.exponent, 2);
  DepthAlignmentOptions strict;
  strict.max_residual = 1.5 * flat.residual;
  EXPECT_FALSE(align(c, strict).agreed);
  EXPECT_NE(align(c, strict).why.find("limit"), std::string::npos) << align(c, strict).why;
}

TEST(AlignDepth, with_too_little_in_common_the_cloud_goes_on) {
  AlignmentCase c = wall_case();
  c.estimate = c.truth.clone();
  c.estimate(cv::Rect(0, 0, 47, 64)) = 0;
  DepthAlignmentOptions options;
  options.min_pixels = 65;
  const AlignedDepth aligned = align(c, options);
  EXPECT_FALSE(aligned.agreed);
  EXPECT_NE(aligned.why.find("only 64 "), std::string::npos) << aligned.why;
  expect_all_positive(aligned.depth);
  options.min_pixels = 64;
  EXPECT_TRUE(align(c, options).agreed);
}

TEST(AlignDepth, with_nothing_visible_the_estimate_is_taken_as_it_is) {
  AlignmentCase c = wall_case();
  c.estimate = slanted_wall(c.truth.size()) * 3;
  c.visible = 0;
  c.estimate(5, 5) = kNan;
  const AlignedDepth aligned = align(c);
  EXPECT_FALSE(aligned.agreed);
  EXPECT_EQ(aligned.why, "nothing is visible");
  EXPECT_TRUE(std::isnan(aligned.seam_step));
  expect_all_positive(aligned.depth);
  for (int x = 6; x < 96; ++x) EXPECT_EQ(aligned.depth(5, x), c.estimate(5, x));
}

TEST(AlignDepth, visible_pixels_keep_the_depth_of_the_cloud_and_missing_goes_before_visible) {
  AlignmentCase c = wall_case();
  c.estimate = c.truth * 0.5f;
  c.missing(cv::Rect(40, 0, 56, 64)) = 1;  // a dilated mask: some of it is hit
  c.cloud(cv::Rect(40, 0, 8, 64)) = 17;
  const AlignedDepth aligned = align(c);
  EXPECT_LT(worst(aligned.depth, c.truth, c.missing), 1e-3);
  EXPECT_EQ(cv::norm(aligned.depth.colRange(0, 40), c.cloud.colRange(0, 40), cv::NORM_INF), 0);
}

TEST(AlignDepth, unknown_depths_are_filled_from_around) {
  AlignmentCase c = wall_case();
  c.estimate = c.truth * 0.5f;
  const float unknown[] = {0, -1, kNan, kInfinity, -kInfinity, 1e-30f, 1e30f};
  for (int i = 0; i < 2000; ++i) {
    const auto at = [&](std::uint32_t what, int most) {
      return static_cast<int>(most * number(i, 0, what));
    };
    c.estimate(at(0, 64), at(1, 96)) = unknown[i % 7];
    c.cloud(at(2, 64), at(3, 96)) = unknown[i % 7];
  }
  c.estimate(cv::Rect(70, 20, 15, 15)) = kNan;
  const AlignedDepth aligned = align(c);
  EXPECT_TRUE(aligned.agreed) << aligned.why;
  expect_all_positive(aligned.depth);
  EXPECT_LT(worst(aligned.depth, c.truth, c.missing), 0.02);
}

TEST(AlignDepth, images_of_any_size_give_positive_depths) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 50), cv::Size(200, 1), cv::Size(2, 2),
                              cv::Size(3, 200), cv::Size(300, 7)}) {
    for (const int min_pixels : {1, 64}) {
      for (const double share : {0.0, 0.5, 1.0}) {
        Depth depth(size, 2.f);
        Mask visible(size, std::uint8_t{0});
        for (int i = 0; i < size.area() * share; ++i) visible(i / size.width, i % size.width) = 255;
        DepthAlignmentOptions options;
        options.min_pixels = min_pixels;
        const AlignedDepth aligned = align_depth(depth, depth, visible, visible == 0, options);
        EXPECT_LT(worst(aligned.depth, depth, Mask(size, 1)), 1e-5) << size;
      }
    }
  }
}

TEST(AlignDepth, bytes_do_not_depend_on_threads) {
  AlignmentCase c = box_world_case(2);
  c.estimate = distorted(c.truth, {0.6, 1.2, 0.1, 0.01}, 5);
  c.estimate(cv::Rect(80, 30, 20, 20)) = 0;
  set_threads(1);
  const AlignedDepth one = align(c);
  set_threads(4);
  const AlignedDepth four = align(c), again = align(c);
  set_threads(0);
  for (const AlignedDepth* other : {&four, &again}) {
    EXPECT_EQ(cv::norm(one.depth, other->depth, cv::NORM_INF), 0);
    EXPECT_EQ(one.scale, other->scale);
    EXPECT_EQ(one.exponent, other->exponent);
    EXPECT_EQ(one.seam_step, other->seam_step);
  }
}

TEST(AlignDepth, what_is_unsound_is_refused) {
  const Depth depth(4, 5, 1.f), other(5, 4, 1.f), unknown(4, 5, 0.f);
  const Mask all(4, 5, 1), none(4, 5, std::uint8_t{0}), less(4, 4, 1);
  EXPECT_THROW(align_depth(other, depth, all, none), Error);
  EXPECT_THROW(align_depth(depth, other, all, none), Error);
  EXPECT_THROW(align_depth(depth, depth, less, none), Error);
  EXPECT_THROW(align_depth(depth, depth, all, less), Error);
  EXPECT_THROW(align_depth({}, {}, {}, {}), Error);
  EXPECT_THROW(align_depth(unknown, unknown, none, all), Error);
  EXPECT_THROW(align_depth(unknown, depth, none, all), Error);
  EXPECT_EQ(cv::countNonZero(align_depth(unknown, unknown, all, none).depth), 0);
  const auto refused = [&](const std::function<void(DepthAlignmentOptions*)>& change) {
    DepthAlignmentOptions options;
    change(&options);
    EXPECT_THROW(align_depth(depth, depth, all, none, options), Error);
  };
  refused([](auto* o) { o->min_exponent = 0; });
  refused([](auto* o) { o->min_exponent = 1.1; });
  refused([](auto* o) { o->max_exponent = 0.9; });
  refused([](auto* o) { o->decay = -1; });
  refused([](auto* o) { o->max_residual = NAN; });
  refused([](auto* o) { o->min_pixels = 0; });
}

}  // namespace
}  // namespace ps
