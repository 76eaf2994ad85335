// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/tradeoff.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libps/core/error.h"

namespace ps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TradeoffPoint point(double seconds, double accuracy) {
  TradeoffPoint p = {"knob", "setting", false, {}, {}, {}};
  p.seconds.value = seconds;
  p.accuracy.value = accuracy;
  return p;
}

using Indices = std::vector<std::size_t>;

TEST(ParetoFront, holds_what_nothing_beats_by_rising_seconds) {
  EXPECT_EQ(pareto_front({point(3, 30), point(1, 10), point(2, 5), point(2, 20), point(4, 29)}),
            (Indices{1, 3, 0}));
  EXPECT_EQ(pareto_front({point(1, 1)}), Indices{0});
  EXPECT_EQ(pareto_front({}), Indices{});
}

TEST(ParetoFront, of_equal_times_takes_the_more_accurate_and_of_equal_accuracies_the_faster) {
  EXPECT_EQ(pareto_front({point(1, 10), point(1, 11)}), Indices{1});
  EXPECT_EQ(pareto_front({point(2, 10), point(1, 10)}), Indices{1});
}

TEST(ParetoFront, equal_points_do_not_beat_each_other) {
  EXPECT_EQ(pareto_front({point(1, 10), point(1, 10), point(0.5, 1)}), (Indices{2, 0, 1}));
}

TEST(ParetoFront, takes_infinite_accuracy_and_leaves_out_nan) {
  EXPECT_EQ(pareto_front({point(1, 10), point(2, kInfinity)}), (Indices{0, 1}));
  EXPECT_EQ(pareto_front({point(kNaN, 90), point(1, 10), point(0, kNaN), point(2, 20)}),
            (Indices{1, 3}));
  EXPECT_EQ(pareto_front({point(1, kNaN)}), Indices{});
}

/// Three methods on samples of very different difficulty: the second is better by 1, the third by
/// 3, but for a little noise.
ScoreTable hard_and_easy(double noise) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  ScoreTable table({{"PSNR", "dB", true}});
  for (int i = 0; i < 30; ++i) {
    const double easy = 10 * normal(random);
    const std::string sample = std::to_string(i);
    for (const auto& [method, better] : {std::pair{"a", 0.0}, {"b", 1.0}, {"c", 3.0}}) {
      table.add({method, sample, i, {easy + better + noise * normal(random)}});
    }
  }
  return table;
}

TEST(WithinSamples, what_is_hard_for_all_methods_does_not_widen_intervals) {
  const ScoreTable table = hard_and_easy(0.1);
  const std::vector<Interval> intervals = within_samples(table, 0);
  ASSERT_EQ(intervals.size(), 3u);
  for (std::size_t m = 0; m < 3; ++m) {
    const Interval plain = table.mean(table.methods()[m], 0);
    EXPECT_NEAR(intervals[m].value, plain.value, 1e-9);
    EXPECT_GT(plain.high - plain.low, 4);
    // Of 30 values of deviation 0.1.
    EXPECT_NEAR(intervals[m].high - intervals[m].low, 2 * 1.96 * 0.1 / std::sqrt(30), 0.025);
    EXPECT_LE(intervals[m].low, intervals[m].value);
    EXPECT_GE(intervals[m].high, intervals[m].value);
  }
  EXPECT_NEAR(intervals[2].value - intervals[0].value, 3, 0.1);
}

TEST(WithinSamples, of_one_method_are_plain_intervals) {
  ScoreTable table({{"PSNR", "dB", true}});
  for (int i = 0; i < 9; ++i) table.add({"a", std::to_string(i), i, {double(i * i)}});
  const Interval within = within_samples(table, 0)[0], plain = table.mean("a", 0);
  EXPECT_EQ(within.value, plain.value);
  EXPECT_EQ(within.low, plain.low);
  EXPECT_EQ(within.high, plain.high);
}

TEST(WithinSamples, leaves_out_samples_that_some_method_has_no_score_of) {
  ScoreTable table({{"PSNR", "dB", true}});
  table.add({"a", "1", 0, {1}});
  table.add({"b", "1", 0, {2}});
  table.add({"a", "2", 1, {100}});
  table.add({"b", "2", 1, {kNaN}});
  const std::vector<Interval> intervals = within_samples(table, 0);
  EXPECT_EQ(intervals[0].value, 1);
  EXPECT_EQ(intervals[1].value, 2);
  EXPECT_EQ(intervals[0].samples, 1u);
}

TEST(WithinSamples, a_method_without_any_score_takes_no_samples_from_the_others) {
  ScoreTable with = hard_and_easy(0.1), without({{"PSNR", "dB", true}});
  for (const ScoreRow& row : with.rows()) without.add(row);
  for (int i = 0; i < 30; ++i) with.add({"d", std::to_string(i), i, {kNaN}});
  const std::vector<Interval> all = within_samples(with, 0), three = within_samples(without, 0);
  ASSERT_EQ(all.size(), 4u);
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(all[m].value, three[m].value);
    EXPECT_EQ(all[m].low, three[m].low);
    EXPECT_EQ(all[m].high, three[m].high);
  }
  EXPECT_TRUE(std::isnan(all[3].value) && std::isnan(all[3].low) && std::isnan(all[3].high));
  EXPECT_EQ(all[3].samples, 0u);
}

TEST(WithinSamples, refuses_methods_of_other_samples) {
  ScoreTable table({{"PSNR", "dB", true}});
  table.add({"a", "1", 0, {1}});
  table.add({"b", "2", 0, {2}});
  EXPECT_THROW(within_samples(table, 0), Error);
  EXPECT_THROW(mean_change(table, "a", "b", 0), Error);
}

TEST(MeanChange, is_of_differences_on_the_same_samples) {
  const ScoreTable table = hard_and_easy(0.1);
  const Interval change = mean_change(table, "b", "a", 0);
  EXPECT_NEAR(change.value, 1, 0.1);
  EXPECT_GT(change.low, 0.9);
  EXPECT_LT(change.high, 1.1);
  const Interval none = mean_change(table, "a", "a", 0);
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 0);
}

}  // namespace
}  // namespace ps
