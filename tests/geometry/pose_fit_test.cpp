// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/pose_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libps/core/random.h"
#include "tests/support/pose_pairs.h"

namespace ps {
namespace {

const Intrinsics kLens{640, 480, 500, 510, 321, 236};

double unit(std::uint32_t i, std::uint32_t what) { return random_unit(7, {i, what, 0, 0}); }

Pose motion(double x, double y, double z, double turn) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d(0.2, 1, -0.1).normalized()).matrix();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

struct Case {
  int count = 200;
  double depth_error = 0;
  double pixels = 0;   ///< standard deviation
  double wild = 0;     ///< share of false matches
  double unknown = 0;  ///< share without a depth
  double scale = 1;    ///< of the whole scene
};

std::vector<Sighting> sightings(const Pose& truth, const Case& c) {
  std::vector<Sighting> result;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(c.count); ++i) {
    const Eigen::Vector3d seen =
        kLens.lift(640 * unit(i, 0), 480 * unit(i, 1), c.scale * (1.5 + 4 * unit(i, 2)));
    const std::array<double, 2> noise = random_normal(8, {i, 0, 0, 0});
    Eigen::Vector2d pixel =
        kLens.project(truth * seen) + c.pixels * Eigen::Vector2d(noise[0], noise[1]);
    if (unit(i, 3) < c.wild) pixel = {640 * unit(i, 4), 480 * unit(i, 5)};
    const double wrong = std::exp(c.depth_error * random_normal(9, {i, 0, 0, 0})[0]);
    const bool known = unit(i, 6) >= c.unknown;
    result.push_back(
        {known ? Eigen::Vector3d(seen * wrong) : Eigen::Vector3d(seen / seen.z() * 3.2 * c.scale),
         pixel, known});
  }
  return result;
}

TEST(FitPose, finds_the_exact_pose_from_a_start_nearby_at_any_scale) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const Pose truth = motion(0.5 * scale, -0.1 * scale, 0.2 * scale, 0.2);
    Case c;
    c.scale = scale;
    const PoseFit fit =
        fit_pose(sightings(truth, c), kLens, motion(0.4 * scale, 0, 0, 0.18), 1, 0.1);
    const PoseError error = pose_error(fit.second_from_first, truth);
    EXPECT_LT(error.degrees, 0.01) << scale;
    EXPECT_LT(error.metres / scale, 0.001) << scale;
    EXPECT_EQ(fit.inliers, 200u);
    EXPECT_DOUBLE_EQ(fit.depth_error, 0.01);
  }
}

TEST(FitPose, leaves_false_matches_out) {
  const Pose truth = motion(0.5, -0.1, 0.2, 0.2);
  Case c;
  c.wild = 0.5;
  c.pixels = 0.5;
  const PoseFit fit = fit_pose(sightings(truth, c), kLens, motion(0.4, 0, 0, 0.18), 0.7, 0.1);
  const PoseError error = pose_error(fit.second_from_first, truth);
  EXPECT_LT(error.degrees, 0.15);
  EXPECT_LT(error.metres, 0.02);
  EXPECT_GT(fit.inliers, 85u);
  EXPECT_LT(fit.inliers, 115u);
}

TEST(FitPose, finds_how_wrong_depths_are_and_the_pose_in_spite_of_it) {
  const Pose truth = motion(0.7, -0.1, 0.2, 0.2);
  for (const double wrong : {0.05, 0.1, 0.2}) {
    Case c;
    c.depth_error = wrong;
    c.pixels = 0.5;
    const PoseFit fit = fit_pose(sightings(truth, c), kLens, motion(0.6, 0, 0.1, 0.19), 0.7, 0.15);
    const PoseError error = pose_error(fit.second_from_first, truth);
    EXPECT_NEAR(fit.depth_error / wrong, 1, 0.25);
    EXPECT_LT(error.degrees, 0.3) << wrong;
    EXPECT_LT(error.metres, 0.06) << wrong;
  }
}

TEST(FitPose, wrong_depths_do_not_matter_without_a_baseline) {
  const Pose truth = motion(0, 0, 0, 0.3);
  Case c;
  c.depth_error = 0.2;
  c.pixels = 0.5;
  const PoseFit fit = fit_pose(sightings(truth, c), kLens, motion(0.05, 0, 0.02, 0.29), 0.7, 0.15);
  const PoseError error = pose_error(fit.second_from_first, truth);
  EXPECT_LT(error.degrees, 0.1);
  EXPECT_LT(error.metres, 0.02);
}

TEST(FitPose, sightings_without_a_depth_help) {
  const Pose truth = motion(0.5, -0.1, 0.2, 0.2);
  Case c;
  c.unknown = 0.95;
  c.depth_error = 0.1;
  c.pixels = 0.5;
  const std::vector<Sighting> all = sightings(truth, c);
  std::vector<Sighting> known;
  for (const Sighting& s : all) {
    if (s.depth_known) known.push_back(s);
  }
  const Pose start = motion(0.45, 0, 0.1, 0.19);
  const PoseFit with = fit_pose(all, kLens, start, 0.7, 0.15);
  const PoseFit without = fit_pose(known, kLens, start, 0.7, 0.15);
  EXPECT_LT(with.rotation_sigma, 0.5 * without.rotation_sigma);
  EXPECT_LT(pose_error(with.second_from_first, truth).degrees,
            pose_error(without.second_from_first, truth).degrees);
}

TEST(FitPose, nothing_seen_leaves_the_start_and_no_certainty) {
  const PoseFit fit = fit_pose({}, kLens, motion(1, 0, 0, 0), 1, 0.1);
  EXPECT_EQ(fit.inliers, 0u);
  EXPECT_EQ(fit.log_likelihood, 0);
  EXPECT_TRUE(fit.second_from_first.isApprox(motion(1, 0, 0, 0)));
  EXPECT_GT(fit.rotation_sigma, 1e3);
}

TEST(StartPose, both_ways_find_the_exact_pose_among_false_matches) {
  const Pose truth = motion(0.5, -0.1, 0.2, 0.2);
  Case c;
  c.wild = 0.4;
  Pose pose;
  ASSERT_TRUE(start_from_points(sightings(truth, c), kLens, 2, &pose));
  EXPECT_LT(pose_error(pose, truth).degrees, 0.3);
  EXPECT_LT(pose_error(pose, truth).metres, 0.02);
  ASSERT_TRUE(start_from_directions(sightings(truth, c), kLens, 2, &pose));
  EXPECT_LT(pose_error(pose, truth).degrees, 1);
  EXPECT_LT(pose_error(pose, truth).metres, 0.1);
}

TEST(StartPose, too_few_sightings_give_none) {
  const Pose truth = motion(0.5, -0.1, 0.2, 0.2);
  for (const int count : {0, 1, 3, 4}) {
    Case c;
    c.count = count;
    Pose pose;
    EXPECT_FALSE(start_from_points(sightings(truth, c), kLens, 2, &pose)) << count;
    EXPECT_FALSE(start_from_directions(sightings(truth, c), kLens, 2, &pose)) << count;
  }
}

}  // namespace
}  // namespace ps
