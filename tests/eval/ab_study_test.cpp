// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/ab_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "libps/core/parallel.h"
#include "libps/eval/image_metrics.h"

namespace ps {
namespace {

bool same(const std::vector<AbTrial>& a, const std::vector<AbTrial>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const AbTrial& x, const AbTrial& y) {
    return x.pair == y.pair && x.sentinel == y.sentinel && x.of_b == y.of_b && x.vote == y.vote &&
           x.swapped == y.swapped;
  });
}

TEST(AbStudy, asks_each_pair_twice_with_sides_exchanged_and_the_second_time_after_all_first_ones) {
  const std::vector<AbTrial> trials = plan_ab_study(30, 4, 1);
  ASSERT_EQ(trials.size(), 64u);
  std::map<std::size_t, std::vector<AbTrial>> votes;
  bool second = false;
  for (const AbTrial& trial : trials) {
    if (trial.sentinel) continue;
    second = second || trial.vote == 1;
    EXPECT_EQ(trial.vote, second ? 1 : 0);
    votes[trial.pair].push_back(trial);
  }
  ASSERT_EQ(votes.size(), 30u);
  for (const auto& [pair, two] : votes) {
    ASSERT_EQ(two.size(), 2u);
    EXPECT_NE(two[0].swapped, two[1].swapped);
  }
}

TEST(AbStudy, has_its_sentinels_anywhere_and_of_many_pairs) {
  std::set<std::size_t> places, of;
  int swapped = 0, of_b = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const std::vector<AbTrial> trials = plan_ab_study(10, 3, seed);
    int count = 0;
    std::set<std::size_t> here;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (!trials[i].sentinel) continue;
      ++count;
      places.insert(i);
      here.insert(trials[i].pair);
      swapped += trials[i].swapped, of_b += trials[i].of_b;
    }
    EXPECT_EQ(count, 3);
    EXPECT_EQ(here.size(), 3u) << "no pair twice while there are others";
    of.insert(here.begin(), here.end());
  }
  EXPECT_GT(places.size(), 20u);
  EXPECT_EQ(of.size(), 10u);
  EXPECT_NEAR(swapped, 60, 25);
  EXPECT_NEAR(of_b, 60, 25);
}

TEST(AbStudy, has_a_s_picture_on_either_side_and_pairs_in_any_order) {
  const std::vector<AbTrial> trials = plan_ab_study(200, 0, 2);
  const auto first_votes = trials.begin() + 200;
  EXPECT_NEAR(std::count_if(trials.begin(), first_votes, [](auto& t) { return t.swapped; }), 100,
              30);
  EXPECT_FALSE(std::is_sorted(trials.begin(), first_votes,
                              [](auto& a, auto& b) { return a.pair < b.pair; }));
  EXPECT_FALSE(std::equal(trials.begin(), first_votes, first_votes,
                          [](auto& a, auto& b) { return a.pair == b.pair; }));
}

TEST(AbStudy, is_a_function_of_the_seed) {
  EXPECT_TRUE(same(plan_ab_study(20, 3, 5), plan_ab_study(20, 3, 5)));
  EXPECT_FALSE(same(plan_ab_study(20, 3, 5), plan_ab_study(20, 3, 6)));
}

TEST(AbStudy, of_nothing_is_nothing_and_more_sentinels_than_pairs_are_possible) {
  EXPECT_TRUE(plan_ab_study(0, 5, 1).empty());
  EXPECT_EQ(plan_ab_study(1, 5, 1).size(), 7u);
  EXPECT_TRUE(shuffled(0, 1, 0).empty());
}

Image stripes(int width, int height) {
  Image image(height, width);
  for (int i = 0; i < width * height; ++i) {
    const float level = i % width / 8 % 2 == 0 ? 0.2f : 0.8f;
    image(i / width, i % width) = {level, 0.5f, 1 - level};
  }
  return image;
}

TEST(BrokenCopy, is_plainly_worse_and_can_be_shown) {
  for (const cv::Size size : {cv::Size(256, 256), {64, 200}, {1, 1}}) {
    const Image image = stripes(size.width, size.height), broken = broken_copy(image, 1);
    ASSERT_EQ(broken.size(), size);
    for (const cv::Vec3f& color : broken) {
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(color[c] >= 0 && color[c] <= 1);
    }
    if (size.width > 1) {
      EXPECT_LT(psnr(image, broken), 17);
    }
  }
}

TEST(BrokenCopy, is_a_function_of_the_seed_whatever_the_threads) {
  const Image image = stripes(40, 30);
  set_threads(1);
  const Image one = broken_copy(image, 3);
  set_threads(3);
  EXPECT_EQ(cv::norm(one, broken_copy(image, 3), cv::NORM_INF), 0);
  set_threads(0);
  EXPECT_GT(cv::norm(one, broken_copy(image, 4), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace ps
