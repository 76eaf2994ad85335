// SPDX-License-Identifier: BSD-3-Clause
#include "libps/core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ps {
namespace {

/// The known answers that the Random123 library publishes for philox4x32-10 (kat_vectors).
TEST(Random, equals_the_published_known_answers) {
  using Bits = std::array<std::uint32_t, 4>;
  EXPECT_EQ(random_bits(0, {0, 0, 0, 0}), (Bits{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(random_bits(0xffffffffffffffff, {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}),
            (Bits{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(random_bits(0x299f31d0a4093822, {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}),
            (Bits{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, units_fill_their_range_evenly) {
  constexpr std::uint32_t kCount = 100000;
  std::array<int, 10> tenths = {};
  double sum = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const double unit = random_unit(5, {1, 2, i, 3});
    ASSERT_GE(unit, 0);
    ASSERT_LT(unit, 1);
    ++tenths[static_cast<std::size_t>(unit * 10)];
    sum += unit;
  }
  EXPECT_NEAR(sum / kCount, 0.5, 0.005);
  for (const int count : tenths) EXPECT_NEAR(count, kCount / 10, 500);
}

TEST(Random, normals_have_mean_0_and_variance_1) {
  constexpr std::uint32_t kCount = 50000;
  double sum = 0, squares = 0, product = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto [a, b] = random_normal(9, {i, 0, 0, 0});
    sum += a + b;
    squares += a * a + b * b;
    product += a * b;
  }
  EXPECT_NEAR(sum / (2 * kCount), 0, 0.02);
  EXPECT_NEAR(squares / (2 * kCount), 1, 0.02);
  EXPECT_NEAR(product / kCount, 0, 0.02);
}

TEST(Random, neighbours_differ_in_key_and_in_every_word_of_the_counter) {
  const auto here = random_bits(1, {0, 0, 0, 0});
  EXPECT_NE(here, random_bits(2, {0, 0, 0, 0}));
  for (std::size_t word = 0; word < 4; ++word) {
    std::array<std::uint32_t, 4> counter = {};
    counter[word] = 1;
    EXPECT_NE(here, random_bits(1, counter)) << word;
  }
}

}  // namespace
}  // namespace ps
