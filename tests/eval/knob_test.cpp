// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/knob.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "libps/core/error.h"

namespace ps {
namespace {

/// Setting s gives 10 s + the sample's number; its time falls with each run.
Knob counted(std::vector<std::size_t>* order) {
  Knob knob = {"size", "", "", {{"score", "", true}}, {{"small"}, {"large", true}}, 3, {}};
  knob.prepare = [order](const KnobSample& sample) {
    const auto runs = std::make_shared<std::map<std::size_t, int>>();
    return KnobBench{Image(1, 1), [=](std::size_t s) {
                       order->push_back(s);
                       const int run = (*runs)[s]++;
                       return KnobTrial{static_cast<double>(10 - run),
                                        {10.0 * static_cast<double>(s) + std::stod(sample.name)},
                                        Image(1, 1, cv::Vec3f::all(static_cast<float>(s)))};
                     }};
  };
  return knob;
}

KnobSample sample(std::size_t i) {
  return {std::to_string(i), static_cast<int>(i), {}, {}, {}, {}};
}

TEST(Knob, settings_take_turns_after_a_warm_up_and_the_least_time_counts) {
  std::vector<std::size_t> order;
  std::size_t last = 0;
  MeasureOptions options;
  options.pictures = 1;
  options.progress = [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(done, ++last);
    EXPECT_EQ(total, 12u);
  };
  const auto results = measure({counted(&order)}, 2, sample, options);
  EXPECT_EQ(last, 12u);
  // A warm-up, three rounds on sample 0, three on sample 1, which begin with the other one.
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0}));
  ASSERT_EQ(results.size(), 1u);
  const ScoreTable& table = results[0].table;
  ASSERT_EQ(table.rows().size(), 4u);
  EXPECT_EQ(table.rows()[0].values, (std::vector<double>{7, 0}));  // the warm-up ran it, too
  EXPECT_EQ(table.rows()[3].method, "large");
  EXPECT_EQ(table.rows()[3].values, (std::vector<double>{8, 11}));
  ASSERT_EQ(results[0].pictures.size(), 1u);
  ASSERT_EQ(results[0].pictures[0].by_setting.size(), 2u);
  EXPECT_EQ(results[0].pictures[0].by_setting[1](0, 0)[0], 1);
}

TEST(Knob, points_are_in_the_order_of_settings_with_changes_against_the_default) {
  std::vector<std::size_t> order;
  const Knob knob = counted(&order);
  const auto points = points_of(knob, measure({knob}, 2, sample)[0].table);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].setting, "small");
  EXPECT_NEAR(points[0].seconds.value, std::sqrt(7.0 * 8), 1e-9);
  EXPECT_EQ(points[0].accuracy.value, 0.5);
  EXPECT_EQ(points[0].change.value, -10);
  EXPECT_TRUE(points[1].is_default);
  EXPECT_EQ(points[1].accuracy.value, 10.5);
  EXPECT_EQ(points[1].accuracy.low, 10.5);  // samples differ alike in both
  EXPECT_EQ(points[1].change.high, 0);
}

TEST(Knob, a_setting_that_was_never_scored_is_a_point_off_the_front) {
  std::vector<std::size_t> order;
  const Knob knob = counted(&order);
  ScoreTable scored = measure({knob}, 2, sample)[0].table, table(scored.columns());
  for (ScoreRow row : scored.rows()) {
    if (row.method == "small") row.values[1] = std::numeric_limits<double>::quiet_NaN();
    table.add(row);
  }
  const auto points = points_of(knob, table);
  EXPECT_TRUE(std::isnan(points[0].accuracy.value));
  EXPECT_EQ(points[1].accuracy.value, 10.5);
  EXPECT_EQ(pareto_front(points), std::vector<std::size_t>{1});
}

TEST(Knob, without_one_default_or_an_accuracy_is_refused) {
  std::vector<std::size_t> order;
  Knob knob = counted(&order);
  knob.settings[0].is_default = true;
  EXPECT_THROW(measure({knob}, 1, sample), Error);
  knob = counted(&order);
  knob.scores[0].higher_is_better = false;
  EXPECT_THROW(measure({knob}, 1, sample), Error);
  knob = counted(&order);
  knob.repeats = 0;
  EXPECT_THROW(measure({knob}, 1, sample), Error);
  EXPECT_TRUE(order.empty());
}

}  // namespace
}  // namespace ps
