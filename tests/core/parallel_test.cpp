// SPDX-License-Identifier: BSD-3-Clause
#include "libps/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace ps {
namespace {

class ParallelFor : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_threads(GetParam()); }
  void TearDown() override { set_threads(0); }
};

TEST_P(ParallelFor, visits_every_index_once) {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 1000u}) {
    std::vector<int> visits(count, 0);
    parallel_for(count, [&](std::size_t i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(count, 1));
  }
}

TEST_P(ParallelFor, throws_the_error_of_the_smallest_index) {
  try {
    parallel_for(100, [](std::size_t i) {
      if (i >= 7) throw std::runtime_error(std::to_string(i));
    });
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "7");
  }
}

TEST_P(ParallelFor, begins_no_more_after_an_error) {
  std::atomic<int> begun{0};
  const auto body = [&](std::size_t) {
    ++begun;
    throw std::runtime_error("stop");
  };
  EXPECT_THROW(parallel_for(100000, body), std::runtime_error);
  EXPECT_LE(begun, 1000);  // a few of each thread
}

TEST_P(ParallelFor, works_inside_itself_and_again_afterwards) {
  std::vector<int> sums(50, 0);
  for (int round = 0; round < 20; ++round) {
    parallel_for(sums.size(), [&](std::size_t i) {
      parallel_for(10, [&](std::size_t j) { sums[i] += static_cast<int>(j); });
    });
  }
  EXPECT_EQ(sums, std::vector<int>(50, 20 * 45));
}

TEST_P(ParallelFor, chunks_cover_the_range_and_do_not_depend_on_threads) {
  std::vector<std::pair<std::size_t, std::size_t>> ranges(4);
  parallel_chunks(10, 3, [&](std::size_t b, std::size_t e) { ranges[b / 3] = {b, e}; });
  const std::vector<std::pair<std::size_t, std::size_t>> expected = {
      {0, 3}, {3, 6}, {6, 9}, {9, 10}};
  EXPECT_EQ(ranges, expected);
}

INSTANTIATE_TEST_SUITE_P(threads, ParallelFor, testing::Values(1, 2, 5));

TEST(Threads, zero_means_one_for_each_core) {
  set_threads(3);
  EXPECT_EQ(threads(), 3);
  set_threads(0);
  EXPECT_GE(threads(), 1);
}

}  // namespace
}  // namespace ps
