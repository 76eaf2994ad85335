// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/cloud_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Point point(float x, float y, float z) {
  Point p;
  p.x = x;
  p.y = y;
  p.z = z;
  return p;
}

Cloud random_cloud(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  Cloud cloud;
  for (std::size_t i = 0; i < size; ++i) {
    cloud.push_back(point(uniform(random), uniform(random), uniform(random)));
  }
  return cloud;
}

Cloud coincident_cloud(std::size_t size) {
  Cloud cloud;
  for (std::size_t i = 0; i < size; ++i) cloud.push_back(point(0.1f, 0.2f, 0.3f));
  return cloud;
}

/// Distance from a point to the nearest of a cloud, by trying them all.
double nearest(const Point& from, const Cloud& cloud) {
  double best = std::numeric_limits<double>::infinity();
  for (const Point& to : cloud) {
    const Eigen::Vector3d d =
        (from.getVector3fMap().cast<double>() - to.getVector3fMap().cast<double>());
    best = std::min(best, d.norm());
  }
  return best;
}

double share_near(const Cloud& from, const Cloud& to, double threshold) {
  double count = 0;
  for (const Point& p : from) count += nearest(p, to) < threshold;
  return count / static_cast<double>(from.size());
}

double mean_nearest(const Cloud& from, const Cloud& to) {
  double sum = 0;
  for (const Point& p : from) sum += nearest(p, to);
  return sum / static_cast<double>(from.size());
}

TEST(CloudScores, are_what_trying_all_pairs_gives) {
  const std::vector<double> thresholds = {0.3, 0.05, 0.1, 0.6};
  for (const std::size_t size : {1u, 2u, 15u, 16u, 17u, 100u, 700u}) {
    const Cloud cloud = random_cloud(size, 1), truth = random_cloud(500, 2);
    const std::vector<CloudScore> scores = cloud_scores(cloud, truth, thresholds);
    ASSERT_EQ(scores.size(), thresholds.size());
    for (std::size_t k = 0; k < thresholds.size(); ++k) {
      const double accuracy = share_near(cloud, truth, thresholds[k]);
      const double completeness = share_near(truth, cloud, thresholds[k]);
      EXPECT_EQ(scores[k].threshold, thresholds[k]);
      EXPECT_EQ(scores[k].accuracy, accuracy);
      EXPECT_EQ(scores[k].completeness, completeness);
      const double sum = accuracy + completeness;
      EXPECT_EQ(scores[k].f_score, sum > 0 ? 2 * accuracy * completeness / sum : 0);
    }
  }
}

TEST(CloudScores, a_point_at_the_threshold_is_not_nearer_than_it) {
  Cloud cloud, truth;
  cloud.push_back(point(0.5f, 0, 0));
  truth.push_back(point(0, 0, 0));
  EXPECT_EQ(cloud_scores(cloud, truth, {0.5})[0].accuracy, 0);
  EXPECT_EQ(cloud_scores(cloud, truth, {0.5 + 1e-9})[0].accuracy, 1);
}

TEST(CloudScores, of_a_cloud_with_itself_are_one) {
  const Cloud cloud = random_cloud(300, 1);
  const CloudScore score = cloud_scores(cloud, cloud, {1e-6})[0];
  EXPECT_EQ(score.accuracy, 1);
  EXPECT_EQ(score.completeness, 1);
  EXPECT_EQ(score.f_score, 1);
}

TEST(CloudScores, half_a_cloud_is_accurate_and_half_complete) {
  Cloud truth;
  for (int i = 0; i < 100; ++i) truth.push_back(point(static_cast<float>(i), 0, 0));
  Cloud half;
  for (int i = 0; i < 100; i += 2) half.push_back(truth[i]);
  const CloudScore score = cloud_scores(half, truth, {0.5})[0];
  EXPECT_EQ(score.accuracy, 1);
  EXPECT_EQ(score.completeness, 0.5);
  EXPECT_NEAR(score.f_score, 2.0 / 3, 1e-15);
}

TEST(CloudScores, of_empty_clouds_are_zero) {
  const Cloud cloud = random_cloud(10, 1), empty;
  for (const auto& scores : {cloud_scores(cloud, empty, {1.0}), cloud_scores(empty, cloud, {1.0}),
                             cloud_scores(empty, empty, {1.0})}) {
    ASSERT_EQ(scores.size(), 1u);
    EXPECT_EQ(scores[0].threshold, 1);
    EXPECT_EQ(scores[0].accuracy, 0);
    EXPECT_EQ(scores[0].completeness, 0);
    EXPECT_EQ(scores[0].f_score, 0);
  }
  EXPECT_TRUE(cloud_scores(cloud, cloud, {}).empty());
}

TEST(CloudScores, points_that_are_not_finite_are_left_out) {
  const Cloud cloud = random_cloud(50, 1), truth = random_cloud(60, 2);
  Cloud with_bad = cloud, bad_truth = truth;
  with_bad.insert(with_bad.begin(), point(kNan, 0, 0));
  with_bad.push_back(point(0, kInfinity, 0));
  bad_truth.insert(bad_truth.begin() + 7, point(0, 0, -kInfinity));
  const CloudScore clean = cloud_scores(cloud, truth, {0.3})[0];
  const CloudScore score = cloud_scores(with_bad, bad_truth, {0.3})[0];
  EXPECT_EQ(score.accuracy, clean.accuracy);
  EXPECT_EQ(score.completeness, clean.completeness);

  Cloud only_bad;
  only_bad.push_back(point(kNan, kNan, kNan));
  EXPECT_EQ(cloud_scores(only_bad, truth, {0.3})[0].f_score, 0);
}

TEST(CloudScores, many_coincident_points_cost_no_more_than_others) {
  const Cloud pile = coincident_cloud(200000);
  Cloud pile_and_far = pile;
  for (int i = 0; i < 30; ++i) pile_and_far.push_back(point(std::ldexp(1.f, i), 0, 0));
  const CloudScore score = cloud_scores(pile_and_far, pile, {0.01})[0];
  EXPECT_EQ(score.accuracy, 200000.0 / 200030);
  EXPECT_EQ(score.completeness, 1);
}

TEST(CloudScores, unsound_thresholds_throw) {
  const Cloud cloud = random_cloud(5, 1);
  for (const double threshold :
       {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(cloud_scores(cloud, cloud, {0.1, threshold}), Error);
  }
}

TEST(ChamferDistance, is_what_trying_all_pairs_gives) {
  for (const std::size_t size : {1u, 2u, 15u, 16u, 17u, 100u, 700u}) {
    const Cloud a = random_cloud(size, 1), b = random_cloud(400, 2);
    EXPECT_NEAR(chamfer_distance(a, b), (mean_nearest(a, b) + mean_nearest(b, a)) / 2, 1e-12);
  }
}

TEST(ChamferDistance, of_a_cloud_with_itself_is_zero_and_of_an_empty_one_nan) {
  const Cloud cloud = random_cloud(100, 1);
  EXPECT_EQ(chamfer_distance(cloud, cloud), 0);
  EXPECT_EQ(chamfer_distance(coincident_cloud(100000), coincident_cloud(3)), 0);
  EXPECT_TRUE(std::isnan(chamfer_distance(cloud, Cloud())));
  EXPECT_TRUE(std::isnan(chamfer_distance(Cloud(), cloud)));
}

TEST(CloudMetrics, do_not_depend_on_the_number_of_threads) {
  const Cloud a = random_cloud(20000, 1), b = random_cloud(15000, 2);
  set_threads(1);
  const double chamfer = chamfer_distance(a, b);
  const CloudScore score = cloud_scores(a, b, {0.03})[0];
  set_threads(5);
  EXPECT_EQ(chamfer_distance(a, b), chamfer);
  EXPECT_EQ(cloud_scores(a, b, {0.03})[0].accuracy, score.accuracy);
  EXPECT_EQ(cloud_scores(a, b, {0.03})[0].completeness, score.completeness);
  set_threads(0);
}

TEST(ShareInFront, counts_points_of_the_origin_before_the_surface_and_no_others) {
  View seen;
  seen.depth = Depth(4, 4, 2.f);
  seen.depth(0, 0) = 0;  // unknown
  seen.intrinsics = {2, 2, 1.5, 1.5, 4, 4};
  seen.world_from_cam.translation() = Eigen::Vector3d(0, 0, 1);
  const auto at = [&](int u, int v, double z) {
    const Eigen::Vector3d p =
        seen.world_from_cam * Eigen::Vector3d((u - 1.5) / 2 * z, (v - 1.5) / 2 * z, z);
    Point made =
        point(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
    made.origin = static_cast<std::uint8_t>(Origin::outpainted);
    return made;
  };
  Cloud cloud;
  EXPECT_TRUE(std::isnan(share_in_front(cloud, Origin::outpainted, seen)));
  cloud.push_back(at(1, 1, 1.5));   // before
  cloud.push_back(at(2, 1, 1.99));  // within the tolerance
  cloud.push_back(at(1, 2, 3));     // behind
  cloud.push_back(at(0, 0, .5));    // where nothing is known
  cloud.push_back(at(9, 1, .5));    // beside the image
  cloud.push_back(at(1, 1, -1));    // behind the camera
  cloud.push_back(at(1, 1, .5));    // of another origin
  cloud.back().origin = static_cast<std::uint8_t>(Origin::observed);
  EXPECT_DOUBLE_EQ(share_in_front(cloud, Origin::outpainted, seen), 1. / 6);
  EXPECT_DOUBLE_EQ(share_in_front(cloud, Origin::observed, seen), 1);
}

}  // namespace
}  // namespace ps
