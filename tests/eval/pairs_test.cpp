// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

constexpr std::size_t kAll = 1000000;

std::vector<Pose> random_poses(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const auto r = [&] { return uniform(random); };
    poses.push_back(pose_at(0.8 * r(), 0.8 * r(), 0.8 * r(), r(), 0.5 * r()));
  }
  return poses;
}

/// A pair and its random number, as the search draws it.
struct DrawnPair {
  std::uint64_t draw;
  std::size_t source, target;
};

bool comes_before(const DrawnPair& a, const DrawnPair& b) {
  return std::tie(a.draw, a.source, a.target) < std::tie(b.draw, b.source, b.target);
}

/// Every pair in range of every two frames, in the order of their draws.
std::vector<DrawnPair> all_drawn(const std::vector<Pose>& poses, const std::vector<int>& worlds,
                                 const PairRange& range, std::uint64_t seed) {
  std::vector<DrawnPair> all;
  for (std::uint32_t i = 0; i < poses.size(); ++i) {
    for (std::uint32_t k = 0; k < poses.size(); ++k) {
      if (i == k || worlds[i] != worlds[k]) continue;
      const Eigen::AngleAxisd turn(poses[i].linear().transpose() * poses[k].linear());
      const double degrees = turn.angle() * 180 / M_PI;
      const double metres = (poses[i].translation() - poses[k].translation()).norm();
      if (degrees < range.least_rotation || degrees > range.most_rotation ||
          metres > range.most_distance) {
        continue;
      }
      const auto bits = random_bits(seed, {i, k, 0x70616972, 0});
      all.push_back({static_cast<std::uint64_t>(bits[0]) << 32 | bits[1], i, k});
    }
  }
  std::sort(all.begin(), all.end(), comes_before);
  return all;
}

/// Takes pairs one at a time: of those whose source was taken least often, the first drawn.
std::set<std::pair<std::size_t, std::size_t>> chosen_one_by_one(std::vector<DrawnPair> left,
                                                                std::size_t most) {
  std::set<std::pair<std::size_t, std::size_t>> chosen;
  std::map<std::size_t, int> taken;
  while (!left.empty() && chosen.size() < most) {
    const auto next =
        std::min_element(left.begin(), left.end(), [&](const DrawnPair& a, const DrawnPair& b) {
          const int of_a = taken[a.source], of_b = taken[b.source];
          return of_a != of_b ? of_a < of_b : comes_before(a, b);
        });
    chosen.emplace(next->source, next->target);
    ++taken[next->source];
    left.erase(next);
  }
  return chosen;
}

TEST(ChoosePairs, are_those_that_taking_one_after_another_of_all_gives) {
  const std::vector<Pose> poses = random_poses(36, 6);
  std::vector<int> one(poses.size(), 0), several(poses.size());
  for (std::size_t i = 0; i < several.size(); ++i) several[i] = static_cast<int>(i % 5);
  for (const std::vector<int>& worlds : {one, several}) {
    for (const PairRange& range : {PairRange(), kWidePairs}) {
      for (const std::uint64_t seed : {1u, 2u}) {
        const std::vector<DrawnPair> all = all_drawn(poses, worlds, range, seed);
        ASSERT_GT(all.size(), 10u);
        for (const std::size_t most :
             {std::size_t{1}, std::size_t{7}, std::size_t{50}, all.size() - 1, all.size()}) {
          std::set<std::pair<std::size_t, std::size_t>> chosen;
          for (const FramePair& pair : choose_pairs(poses, worlds, range, most, seed)) {
            chosen.emplace(pair.source, pair.target);
          }
          EXPECT_EQ(chosen, chosen_one_by_one(all, most)) << most;
        }
      }
    }
  }
}

TEST(ChoosePairs, are_all_those_in_range_and_no_others) {
  const std::vector<Pose> poses = random_poses(40, 1);
  const PairRange range;
  std::set<std::pair<std::size_t, std::size_t>> chosen;
  for (const FramePair& pair : choose_pairs(poses, {}, range, kAll)) {
    EXPECT_TRUE(chosen.emplace(pair.source, pair.target).second);
  }
  std::size_t expected = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Eigen::AngleAxisd turn(poses[i].linear().transpose() * poses[k].linear());
      const double degrees = turn.angle() * 180 / M_PI;
      const double metres = (poses[i].translation() - poses[k].translation()).norm();
      const bool in = degrees >= 20 && degrees <= 60 && metres <= 1;
      EXPECT_EQ(chosen.count({i, k}), in ? 1u : 0u) << degrees << " " << metres;
      expected += in;
    }
  }
  EXPECT_GT(expected, 100u);
}

TEST(ChoosePairs, hold_their_ends_and_say_rotation_and_distance) {
  const std::vector<Pose> poses = {pose_at(0, 0, 0, 0), pose_at(1, 0, 0, 0.5)};
  const double degrees = 0.5 * 180 / M_PI;
  const auto chosen = choose_pairs(poses, {}, {degrees - 1e-9, degrees + 1e-9, 1}, kAll);
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].source, 0u);
  EXPECT_EQ(chosen[1].source, 1u);
  EXPECT_NEAR(chosen[0].rotation, degrees, 1e-9);
  EXPECT_DOUBLE_EQ(chosen[0].distance, 1);
  EXPECT_TRUE(choose_pairs(poses, {}, {degrees + 1, 60, 1}, kAll).empty());
  EXPECT_TRUE(choose_pairs(poses, {}, {20, 60, 0.99}, kAll).empty());
}

TEST(ChoosePairs, knows_turns_of_nothing_and_of_half_a_circle) {
  const std::vector<Pose> poses = {pose_at(0, 0, 0, 0), pose_at(0, 0, 0, 0),
                                   pose_at(0, 0, 0, M_PI)};
  const auto none = choose_pairs(poses, {}, {0, 0, 0}, kAll);
  ASSERT_EQ(none.size(), 2u);
  EXPECT_EQ(none[0].rotation, 0);
  EXPECT_EQ(choose_pairs(poses, {}, {179.9, 180, 0}, kAll).size(), 4u);
}

TEST(ChoosePairs, are_of_one_world) {
  const std::vector<Pose> poses(4, Pose::Identity());
  const auto chosen = choose_pairs(poses, {1, 2, 1, 2}, kWidePairs, kAll);
  ASSERT_EQ(chosen.size(), 4u);
  for (const FramePair& pair : chosen) EXPECT_EQ(pair.source % 2, pair.target % 2);
}

TEST(ChoosePairs, are_spread_over_the_sources) {
  const std::vector<Pose> poses = random_poses(30, 2);
  std::map<std::size_t, std::size_t> in_all, in_some;
  for (const FramePair& pair : choose_pairs(poses, {}, kWidePairs, kAll)) ++in_all[pair.source];
  const auto some = choose_pairs(poses, {}, kWidePairs, 70);
  EXPECT_EQ(some.size(), 70u);
  for (const FramePair& pair : some) ++in_some[pair.source];
  for (const auto& [source, count] : in_all) {
    EXPECT_GE(in_some[source], std::min<std::size_t>(count, 2)) << source;
    EXPECT_LE(in_some[source], 3u) << source;
  }
}

TEST(ChoosePairs, is_a_function_of_the_seed_whatever_the_threads) {
  const std::vector<Pose> poses = random_poses(30, 3);
  const auto targets = [&](std::uint64_t seed) {
    std::vector<std::size_t> all;
    for (const FramePair& pair : choose_pairs(poses, {}, kWidePairs, 25, seed)) {
      all.push_back(pair.source * 100 + pair.target);
    }
    return all;
  };
  set_threads(1);
  const auto one = targets(4);
  set_threads(3);
  EXPECT_EQ(targets(4), one);
  set_threads(0);
  EXPECT_NE(targets(5), one);
}

TEST(ChoosePairs, asks_for_few_poses_where_worlds_are_many_and_pairs_few) {
  constexpr int kWorlds = 4000;
  std::vector<Pose> poses;
  std::vector<int> worlds;
  for (int world = 0; world < kWorlds; ++world) {
    for (const Pose& pose : random_poses(4, static_cast<unsigned>(world))) {
      poses.push_back(pose);
      worlds.push_back(world);
    }
  }
  const PairRange range;
  const auto all = choose_pairs(poses, worlds, range, kAll, 7);
  for (const std::size_t most : {std::size_t{1}, std::size_t{24}, all.size()}) {
    std::atomic<int> asked = 0;
    const auto pose = [&](std::size_t i) {
      ++asked;
      return poses[i];
    };
    const auto chosen = choose_pairs_lazily(worlds, pose, range, most, 7);
    ASSERT_EQ(chosen.size(), most);
    EXPECT_LT(asked, most == all.size() ? 4 * kWorlds + 1 : 1000);
    // What is chosen when more is asked for holds what is chosen when less is.
    std::set<std::pair<std::size_t, std::size_t>> more;
    for (const FramePair& pair : choose_pairs(poses, worlds, range, most + 500, 7)) {
      more.emplace(pair.source, pair.target);
    }
    for (const FramePair& pair : chosen) EXPECT_EQ(more.count({pair.source, pair.target}), 1u);
  }
}

TEST(ChoosePairs, of_none_and_of_one_frame_are_none_and_unsound_ranges_throw) {
  EXPECT_TRUE(choose_pairs({}, {}, kWidePairs, kAll).empty());
  EXPECT_TRUE(choose_pairs({Pose::Identity()}, {}, kWidePairs, kAll).empty());
  EXPECT_TRUE(choose_pairs(random_poses(5, 1), {}, kWidePairs, 0).empty());
  const std::vector<Pose> poses = random_poses(2, 1);
  EXPECT_THROW(choose_pairs(poses, {1}, kWidePairs, kAll), Error);
  EXPECT_THROW(choose_pairs(poses, {}, {60, 20, 1}, kAll), Error);
  EXPECT_THROW(choose_pairs(poses, {}, {0, 181, 1}, kAll), Error);
  EXPECT_THROW(choose_pairs(poses, {}, {0, 20, -1}, kAll), Error);
  EXPECT_THROW(choose_pairs(poses, {}, {std::nan(""), 20, 1}, kAll), Error);
}

}  // namespace
}  // namespace ps
