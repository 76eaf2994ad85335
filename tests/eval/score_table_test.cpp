// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/score_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libps/core/error.h"

namespace ps {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(ScoreTable, has_a_mean_for_each_method_and_column_without_nan) {
  ScoreTable table({{"AbsRel", "", false}, {"PSNR", "dB", true}});
  table.add({"ours", "a", 0, {1, 20}});
  table.add({"constant", "a", 0, {5, kNan}});
  table.add({"ours", "b", 1, {3, kNan}});
  EXPECT_EQ(table.methods(), (std::vector<std::string>{"ours", "constant"}));
  EXPECT_EQ(table.mean("ours", 0).value, 2);
  EXPECT_EQ(table.mean("ours", 0).low, 1);
  EXPECT_EQ(table.mean("ours", 1).value, 20);
  EXPECT_EQ(table.mean("ours", 1).samples, 1u);
  EXPECT_TRUE(std::isnan(table.mean("constant", 1).value));
  EXPECT_TRUE(std::isnan(table.mean("absent", 0).value));
}

TEST(ScoreTable, draws_whole_groups) {
  ScoreTable each({{"x", "", false}}), grouped = each;
  for (int i = 0; i < 40; ++i) {
    const double value = i / 10;
    each.add({"m", std::to_string(i), i, {value}});
    grouped.add({"m", std::to_string(i), i / 10, {value}});
  }
  const Interval a = each.mean("m", 0), b = grouped.mean("m", 0);
  EXPECT_EQ(a.value, b.value);
  EXPECT_GT(b.high - b.low, 1.5 * (a.high - a.low));
}

TEST(ScoreTable, refuses_rows_that_do_not_fit) {
  ScoreTable table({{"x", "", false}});
  EXPECT_THROW(table.add({"m", "a", 0, {}}), Error);
  EXPECT_THROW(table.add({"m", "a", 0, {1, 2}}), Error);
}

}  // namespace
}  // namespace ps
