// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <random>
#include <set>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "tests/support/box_world.h"
#include "tests/support/room_view.h"

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

/// Of the pixels whose surface is known, the share that is in the right mask.
double right(const Visibility& found, const Mask& seen, const Depth& depth) {
  const Mask known = depth > 0;
  const Mask right = (found.visible & seen) | (found.invisible & (1 - seen));
  return cv::countNonZero(right & known) / static_cast<double>(cv::countNonZero(known));
}

/// All but a pixel or two along the edges of things: the error halves with twice the pixels.
TEST(TrueVisibility, is_what_rays_say) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const rooms::Room room(seed);
    rooms::CameraOptions lens;
    lens.width = 240, lens.height = 180;
    const rooms::Camera a = rooms::random_camera(room, seed, lens);
    const rooms::Camera b = rooms::moved(room, a, seed, 0.6f, 0.8f);
    const View source = room_view(room, a);
    const View target = room_view(room, b);
    const std::vector<float> depth(target.depth.begin(), target.depth.end());
    std::vector<std::uint8_t> rays = rooms::seen_from(room, a, b, depth);
    const Mask seen(lens.height, lens.width, rays.data());
    const double exact = right(true_visibility(source, target), seen, target.depth);
    std::printf("  %.3f seen; right %.4f\n", cv::mean(seen)[0], exact);
    EXPECT_GT(exact, 0.97);
  }
}

TEST(TrueVisibility, of_a_view_by_itself_is_all_and_from_a_camera_turned_away_nothing) {
  const Intrinsics k = intrinsics_from_fov(40, 30, 70);
  const View view = box_world_view(k, pose_at(0, 0, -3, 0)),
             back = box_world_view(k, pose_at(0, 0, -3, M_PI));
  EXPECT_EQ(cv::countNonZero(true_visibility(view, view).visible), 1200);
  EXPECT_EQ(cv::countNonZero(true_visibility(view, view).invisible), 0);
  EXPECT_EQ(cv::countNonZero(true_visibility(back, view).visible), 0);
  EXPECT_EQ(cv::countNonZero(true_visibility(back, view).invisible), 1200);
}

TEST(TrueVisibility, has_pixels_of_unknown_depth_in_neither_mask) {
  const Intrinsics k = intrinsics_from_fov(40, 30, 70);
  View source = box_world_view(k, pose_at(0, 0, -3, 0)), target = source;
  target.depth(3, 5) = 0;
  target.depth(3, 6) = std::nanf("");
  source.depth(cv::Rect(10, 10, 5, 5)).setTo(-1);
  source.depth(20, 20) = INFINITY;  // its neighbours are known
  const Visibility found = true_visibility(source, target);
  EXPECT_EQ(found.visible(3, 5) + found.invisible(3, 5), 0);
  EXPECT_EQ(found.visible(3, 6) + found.invisible(3, 6), 0);
  EXPECT_EQ(found.visible(12, 12) + found.invisible(12, 12), 0);
  EXPECT_EQ(cv::countNonZero(found.invisible), 0);
}

TEST(TrueVisibility, takes_lenses_and_sizes_that_differ) {
  const View source = box_world_view(intrinsics_from_fov(160, 120, 90), pose_at(0, 0, -3, 0)),
             target = box_world_view({50, 70, 100, 90, 20, 40}, pose_at(0, 0, -3, 0));
  const Visibility found = true_visibility(source, target);
  EXPECT_EQ(found.visible.size(), target.depth.size());
  EXPECT_GT(cv::countNonZero(found.visible), 3400);
}

TEST(TrueVisibility, of_one_pixel_works_and_unsound_views_throw) {
  View one;
  one.intrinsics = intrinsics_from_fov(1, 1, 60);
  one.depth = Depth(1, 1, 2.f);
  EXPECT_EQ(true_visibility(one, one).visible(0, 0), 1);
  View cut = one;
  cut.depth = Depth(1, 2, 2.f);
  EXPECT_THROW(true_visibility(cut, one), Error);
  EXPECT_THROW(true_visibility(one, cut), Error);
  View blind = one;
  blind.depth.release();
  EXPECT_THROW(true_visibility(blind, one), Error);
  EXPECT_THROW(true_visibility(one, blind), Error);
  EXPECT_THROW(true_visibility(one, View()), Error);
}

}  // namespace
}  // namespace ps
