// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/stress_given.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "libps/scene/stress_axes.h"
#include "libps/scene/stress_suite.h"
#include "tests/scene/tiny_suite.h"

namespace ps::stress {
namespace {

using Numbers = std::vector<std::size_t>;

/// Frames that stand so many metres apart, in a row.
std::function<Pose(std::size_t)> row_of(double metres) {
  return [metres](std::size_t i) {
    Pose pose = Pose::Identity();
    pose.translation().x() = metres * static_cast<double>(i);
    return pose;
  };
}

TEST(StressGiven, walks_are_spread_evenly_and_views_left_out_lie_between_frames) {
  const auto walks = choose_walks(std::vector<int>(17, 3), row_of(.01), tiny_suite());
  ASSERT_EQ(walks.size(), 1u);
  EXPECT_EQ(walks[0].frames, (Numbers{0, 4, 12, 16}));
  EXPECT_EQ(walks[0].held_out, Numbers{8});
}

TEST(StressGiven, walks_are_narrowed_to_their_middle_until_neighbours_overlap) {
  const auto walks = choose_walks(std::vector<int>(41, 0), row_of(.09), tiny_suite());
  ASSERT_EQ(walks.size(), 1u);
  EXPECT_EQ(walks[0].frames, (Numbers{11, 15, 23, 28})) << "half a metre apart at most";
  EXPECT_EQ(walks[0].held_out, Numbers{19});
}

TEST(StressGiven, worlds_of_few_frames_give_few_and_those_of_fewer_than_three_none) {
  SuiteOptions options = tiny_suite();
  options.rooms = 2;
  const auto walks = choose_walks({0, 0, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3}, row_of(.1), options);
  ASSERT_EQ(walks.size(), 2u) << "as many as there are rooms";
  EXPECT_EQ(walks[0].frames, (Numbers{2, 4}));
  EXPECT_EQ(walks[0].held_out, Numbers{3});
  EXPECT_EQ(walks[1].frames, (Numbers{5, 6, 8}));
  EXPECT_EQ(walks[1].held_out, Numbers{7});
}

/// A room's own frames, given, are the same as the room.
TEST(StressGiven, frames_take_the_place_of_a_rooms_in_every_axis_that_can_have_them) {
  SuiteOptions options = tiny_suite();
  const World room = make_world(room_seed(options, 0), 4, 1, options.size);
  const std::vector<Axis> fusion = fusion_axes(options);
  const auto given = std::make_shared<GivenFrames>();
  given->walks = {{room.frames, room.held_out}};
  options.given = given;
  std::size_t compared = 0;
  const auto compare = [&](const std::vector<Axis>& rooms, const std::vector<Axis>& data) {
    ASSERT_EQ(rooms.size(), data.size());
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      if (!data[i].rooms_alone.empty()) continue;
      const Outcome a = rooms[i].run("all points", rooms[i].values[1]);
      const Outcome b = data[i].run("all points", data[i].values[1]);
      EXPECT_EQ(a.digest, b.digest) << data[i].name;
      EXPECT_EQ(a.score(), b.score()) << data[i].name;
      ++compared;
    }
  };
  compare(fusion, fusion_axes(options));
  EXPECT_EQ(compared, fusion.size() - 1) << "all but the mirror";
  for (const Axis& axis : cloud_axes(options)) {
    if (!axis.rooms_alone.empty()) continue;
    EXPECT_TRUE(std::isfinite(axis.run("nearest point", axis.values[1]).score())) << axis.name;
    EXPECT_EQ(axis.truth(axis.values[1]).size(), axis.run("ours", axis.values[1]).picture.size());
  }
}

TEST(StressGiven, frames_are_made_as_small_as_rooms_whatever_their_aspect) {
  const World large = make_world(9000, 3, 1, {96, 48});
  const World small = given_world({large.frames, large.held_out}, {48, 36});
  EXPECT_EQ(small.frames[2].color.size(), cv::Size(48, 24));
  EXPECT_EQ(small.held_out[0].depth.size(), cv::Size(48, 24));
  EXPECT_NEAR(small.frames[0].intrinsics.fx, large.frames[0].intrinsics.fx / 2, 1e-9);
  EXPECT_EQ(small.frames[0].world_from_cam.matrix(), large.frames[0].world_from_cam.matrix());
  EXPECT_GT(cv::countNonZero(small.covered[0]), 100);
  EXPECT_EQ(reduced(small.frames[0], {48, 36}).color.size(), cv::Size(48, 24)) << "never larger";
}

TEST(StressGiven, pairs_are_photo_and_truth) {
  const Photo room = make_photo(9000, {64, 64});
  View target = room.shoot(room.lens, room.world_from_cam);
  SuiteOptions options = tiny_suite();
  const auto given = std::make_shared<GivenFrames>();
  given->pairs = {{room.known, target}};
  options.given = given;
  int left_out = 0;
  for (const Axis& axis : photo_axes(options, {})) {
    left_out += !axis.rooms_alone.empty();
    const Image& truth = axis.name == "missing-share" ? room.known.color : target.color;
    if (axis.name != "missing-share" && axis.name != "photo-noise") continue;
    EXPECT_EQ(digest_of(axis.truth(axis.values[1])), digest_of(truth)) << axis.name;
    const double score = axis.run("nearest", axis.values[1]).score();
    EXPECT_GT(score, axis.run("nearest", axis.values[axis.values.size() - 3]).score()) << axis.name;
    EXPECT_GT(score, 10) << axis.name;
  }
  EXPECT_EQ(left_out, 2) << "rotation and translation";
}

TEST(StressGiven, a_pair_that_sees_nothing_in_common_scores_nothing) {
  const Photo room = make_photo(9000, {48, 48});
  View target = room.shoot(room.lens, room.world_from_cam);
  target.depth.setTo(0);
  SuiteOptions options = tiny_suite();
  const auto given = std::make_shared<GivenFrames>();
  given->pairs = {{room.known, target}};
  options.given = given;
  for (const Axis& axis : photo_axes(options, {})) {
    if (axis.name != "photo-bias") continue;
    EXPECT_TRUE(std::isnan(axis.run("nearest", axis.values[0]).score()));
  }
}

TEST(StressGiven, a_principal_point_is_off_by_its_share_of_the_width) {
  const World world = make_world(9000, 1, 1, {48, 36});
  const View off = with_principal_point(world.frames[0], .25);
  EXPECT_DOUBLE_EQ(off.intrinsics.cx, world.frames[0].intrinsics.cx + 12);
  EXPECT_EQ(off.intrinsics.cy, world.frames[0].intrinsics.cy);
  EXPECT_EQ(off.intrinsics.fx, world.frames[0].intrinsics.fx);
  for (const Axis& axis : fusion_axes(tiny_suite())) {
    if (axis.name != "principal-point") continue;
    EXPECT_GT(axis.run("ours", 0).score(), axis.run("ours", 16).score() + 3);
  }
}

}  // namespace
}  // namespace ps::stress
