// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> normals(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(3, 2);
  std::vector<double> values(count);
  for (double& value : values) value = normal(random);
  return values;
}

TEST(Median, is_the_middle_or_the_mean_of_the_middle_two) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median({7}), 7);
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(Mean, of_nothing_is_nan) {
  EXPECT_EQ(mean({1, 2, 6}), 3);
  EXPECT_TRUE(std::isnan(mean({})));
}

TEST(Bootstrap, of_a_mean_is_about_as_wide_as_theory_says) {
  const std::vector<double> values = normals(400, 1);
  double square = 0;
  for (const double v : values) square += (v - mean(values)) * (v - mean(values));
  const double error = std::sqrt(square) / 400;  // of the mean
  const Interval interval = bootstrap_mean(values);
  EXPECT_DOUBLE_EQ(interval.value, mean(values));
  EXPECT_EQ(interval.samples, 400u);
  EXPECT_NEAR(interval.high - interval.value, 1.96 * error, 0.2 * error);
  EXPECT_NEAR(interval.value - interval.low, 1.96 * error, 0.2 * error);
}

TEST(Bootstrap, intervals_hold_the_true_mean_about_as_often_as_their_level) {
  int held = 0;
  BootstrapOptions options;
  options.resamples = 400;
  options.level = 0.8;
  for (unsigned seed = 0; seed < 200; ++seed) {
    options.seed = seed;
    const Interval interval = bootstrap_mean(normals(60, seed), {}, options);
    held += interval.low <= 3 && 3 <= interval.high;
  }
  EXPECT_GT(held, 145);
  EXPECT_LT(held, 175);
}

TEST(Bootstrap, draws_whole_groups_so_that_copies_of_values_do_not_narrow_it) {
  const std::vector<double> values = normals(50, 2);
  std::vector<double> copies;
  std::vector<int> groups;
  for (int i = 0; i < 50; ++i) {
    copies.insert(copies.end(), 9, values[static_cast<std::size_t>(i)]);
    groups.insert(groups.end(), 9, i);
  }
  const Interval each = bootstrap_mean(values), grouped = bootstrap_mean(copies, groups),
                 fooled = bootstrap_mean(copies);
  EXPECT_DOUBLE_EQ(grouped.value, each.value);
  EXPECT_NEAR(grouped.low, each.low, 1e-12);
  EXPECT_NEAR(grouped.high, each.high, 1e-12);
  EXPECT_EQ(grouped.samples, 450u);
  EXPECT_LT(fooled.high - fooled.low, 0.5 * (each.high - each.low));
}

TEST(Bootstrap, of_one_group_draws_its_values) {
  const std::vector<double> values = normals(50, 2);
  EXPECT_EQ(bootstrap_mean(values, std::vector<int>(50, 7)).low, bootstrap_mean(values).low);
}

TEST(Bootstrap, leaves_nan_out_and_says_of_how_many_it_is) {
  const Interval interval = bootstrap_mean({1, kNan, 3, kNan}, {0, 0, 1, 2});
  EXPECT_EQ(interval.value, 2);
  EXPECT_EQ(interval.samples, 2u);
  EXPECT_EQ(interval.low, 1);
  EXPECT_EQ(interval.high, 3);
}

TEST(Bootstrap, of_nothing_is_nan_of_one_without_bounds_and_of_infinite_values_infinite) {
  EXPECT_TRUE(std::isnan(bootstrap_mean({}).value));
  EXPECT_TRUE(std::isnan(bootstrap_mean({kNan}).low));
  EXPECT_EQ(bootstrap_mean({}).samples, 0u);
  const Interval one = bootstrap_mean({5});
  EXPECT_EQ(one.value, 5);
  EXPECT_EQ(one.samples, 1u);
  EXPECT_TRUE(std::isnan(one.low) && std::isnan(one.high));
  const Interval left = bootstrap_mean({5, kNan}, {1, 2});
  EXPECT_EQ(left.value, 5);
  EXPECT_TRUE(std::isnan(left.low) && std::isnan(left.high));
  EXPECT_EQ(bootstrap_mean({kInfinity, kInfinity}).low, kInfinity);
}

TEST(Bootstrap, is_a_function_of_the_seed_whatever_the_threads) {
  const std::vector<double> values = normals(40, 3);
  BootstrapOptions options;
  options.seed = 5;
  set_threads(1);
  const Interval one = bootstrap_mean(values, {}, options);
  set_threads(3);
  const Interval three = bootstrap_mean(values, {}, options);
  set_threads(0);
  EXPECT_EQ(one.low, three.low);
  EXPECT_EQ(one.high, three.high);
  options.seed = 6;
  EXPECT_NE(bootstrap_mean(values, {}, options).low, one.low);
}

TEST(Bootstrap, takes_any_figure) {
  const std::vector<double> values = normals(101, 4);
  const Interval interval = bootstrap(values.size(), [&](const std::vector<std::size_t>& drawn) {
    std::vector<double> chosen;
    for (const std::size_t i : drawn) chosen.push_back(values[i]);
    return median(chosen);
  });
  EXPECT_EQ(interval.value, median(values));
  EXPECT_LT(interval.low, interval.value);
  EXPECT_GT(interval.high, interval.value);
}

TEST(Bootstrap, refuses_unsound_options) {
  EXPECT_THROW(bootstrap_mean({1, 2}, {}, {0, 0.95, 0}), Error);
  EXPECT_THROW(bootstrap_mean({1, 2}, {}, {10, 1, 0}), Error);
  EXPECT_THROW(bootstrap_mean({1, 2}, {}, {10, kNan, 0}), Error);
  EXPECT_THROW(bootstrap_mean({1, 2}, {1}), Error);
}

}  // namespace
}  // namespace ps
