// SPDX-License-Identifier: BSD-3-Clause
#include "libps/core/words.h"

#include <gtest/gtest.h>

#include <limits>

namespace ps {
namespace {

TEST(Words, in_digits_is_as_short_as_it_can_be) {
  EXPECT_EQ(in_digits(20), "20");
  EXPECT_EQ(in_digits(0.25), "0.25");
  EXPECT_EQ(in_digits(1.0 / 3, 4), "0.3333");
  EXPECT_EQ(in_digits(123456, 3), "1.23e+05");
  EXPECT_EQ(in_digits(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(std::stod(in_digits(0.1, 17)), 0.1);
}

TEST(Words, counted_knows_one_from_many) {
  EXPECT_EQ(counted(0, "pair"), "0 pairs");
  EXPECT_EQ(counted(1, "pair"), "1 pair");
  EXPECT_EQ(counted(2, "pair"), "2 pairs");
  EXPECT_EQ(counted(1, "axis", "axes"), "1 axis");
  EXPECT_EQ(counted(3, "axis", "axes"), "3 axes");
}

}  // namespace
}  // namespace ps
