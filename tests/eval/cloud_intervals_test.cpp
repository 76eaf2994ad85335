// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/cloud_intervals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/cloud_metrics.h"

namespace ps {
namespace {

Point point(float x, float y, float z) {
  Point p;
  p.x = x, p.y = y, p.z = z;
  return p;
}

Cloud random_cloud(std::size_t size, unsigned seed, float side = 4) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-side / 2, side / 2);
  Cloud cloud;
  for (std::size_t i = 0; i < size; ++i) {
    cloud.push_back(point(uniform(random), uniform(random), uniform(random)));
  }
  return cloud;
}

TEST(NearestDistances, are_what_trying_all_gives) {
  Cloud from = random_cloud(300, 1);
  const Cloud to = random_cloud(200, 2);
  from[7].y = std::nanf("");
  const std::vector<double> metres = nearest_distances(from, to);
  ASSERT_EQ(metres.size(), 300u);
  for (std::size_t i = 0; i < from.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (const Point& p : to) {
      best = std::min(
          best,
          (from[i].getVector3fMap().cast<double>() - p.getVector3fMap().cast<double>()).norm());
    }
    if (i == 7) {
      EXPECT_TRUE(std::isnan(metres[i]));
    } else {
      EXPECT_NEAR(metres[i], best, 1e-12);
    }
  }
  EXPECT_EQ(nearest_distances(from, {})[0], std::numeric_limits<double>::infinity());
  EXPECT_TRUE(nearest_distances({}, to).empty());
}

TEST(CloudIntervals, are_about_the_scores_without_intervals) {
  Cloud cloud = random_cloud(900, 1);
  cloud[3].x = std::nanf("");
  const Cloud truth = random_cloud(700, 2);
  const std::vector<double> thresholds = {0.1, 0.3};
  const std::vector<CloudScore> plain = cloud_scores(cloud, truth, thresholds);
  const CloudIntervals found = cloud_intervals(cloud, truth, thresholds);
  ASSERT_EQ(found.scores.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(found.scores[k].threshold, thresholds[k]);
    EXPECT_DOUBLE_EQ(found.scores[k].accuracy.value, plain[k].accuracy);
    EXPECT_DOUBLE_EQ(found.scores[k].completeness.value, plain[k].completeness);
    EXPECT_DOUBLE_EQ(found.scores[k].f_score.value, plain[k].f_score);
    for (const Interval& i :
         {found.scores[k].accuracy, found.scores[k].completeness, found.scores[k].f_score}) {
      EXPECT_LT(i.low, i.value);
      EXPECT_GT(i.high, i.value);
      EXPECT_LT(i.high - i.low, 0.25);
      EXPECT_GT(i.samples, 400u);
    }
  }
  EXPECT_NEAR(found.chamfer.value, chamfer_distance(cloud, truth), 1e-12);
  EXPECT_LT(found.chamfer.low, found.chamfer.value);
  EXPECT_GT(found.chamfer.high, found.chamfer.value);
}

TEST(CloudIntervals, do_not_narrow_when_every_point_is_there_twice) {
  const Cloud cloud = random_cloud(900, 1), truth = random_cloud(700, 2);
  Cloud doubled = cloud, doubled_truth = truth;
  doubled += cloud, doubled_truth += truth;
  const Interval once = cloud_intervals(cloud, truth, {0.2}).scores[0].accuracy,
                 twice = cloud_intervals(doubled, doubled_truth, {0.2}).scores[0].accuracy;
  EXPECT_DOUBLE_EQ(once.low, twice.low);
  EXPECT_DOUBLE_EQ(once.high, twice.high);
}

TEST(CloudIntervals, of_an_empty_cloud_are_nothing) {
  const Cloud cloud = random_cloud(5, 1);
  for (const auto& [a, b] : {std::pair<Cloud, Cloud>{cloud, {}}, {{}, cloud}, {{}, {}}}) {
    const CloudIntervals none = cloud_intervals(a, b, {0.1});
    ASSERT_EQ(none.scores.size(), 1u);
    EXPECT_EQ(none.scores[0].f_score.value, 0);
    EXPECT_TRUE(std::isnan(none.scores[0].f_score.high));
    EXPECT_TRUE(std::isnan(none.chamfer.value));
  }
}

TEST(CloudIntervals, of_one_block_are_not_known) {
  const Cloud one = random_cloud(1, 1);
  const CloudIntervals found = cloud_intervals(one, one, {0.1});
  EXPECT_EQ(found.scores[0].f_score.value, 1);
  EXPECT_TRUE(std::isnan(found.scores[0].f_score.low));
  EXPECT_EQ(found.chamfer.value, 0);
  EXPECT_TRUE(std::isnan(found.chamfer.high));
}

TEST(CloudIntervals, do_not_depend_on_threads_or_on_the_order_of_points) {
  Cloud cloud = random_cloud(500, 1);
  const Cloud truth = random_cloud(400, 2);
  set_threads(1);
  const CloudIntervals one = cloud_intervals(cloud, truth, {0.2});
  set_threads(3);
  const CloudIntervals three = cloud_intervals(cloud, truth, {0.2});
  set_threads(0);
  EXPECT_EQ(one.scores[0].f_score.low, three.scores[0].f_score.low);
  EXPECT_EQ(one.chamfer.high, three.chamfer.high);
  std::reverse(cloud.begin(), cloud.end());
  EXPECT_EQ(cloud_intervals(cloud, truth, {0.2}).scores[0].f_score.low, one.scores[0].f_score.low);
}

TEST(CloudIntervals, refuse_thresholds_and_blocks_that_are_not_positive) {
  const Cloud cloud = random_cloud(5, 1);
  EXPECT_THROW(cloud_intervals(cloud, cloud, {0}), Error);
  EXPECT_THROW(cloud_intervals(cloud, cloud, {0.1}, 0), Error);
  EXPECT_THROW(cloud_intervals(cloud, cloud, {0.1}, INFINITY), Error);
}

}  // namespace
}  // namespace ps
