// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/relative_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/rooms/room.h"
#include "tests/support/pose_pairs.h"

namespace ps {
namespace {

constexpr std::uint64_t kRoom = 3;

rooms::Camera first_camera(std::uint64_t seed = kRoom) {
  rooms::CameraOptions options;
  options.width = 480;
  options.height = 360;
  options.min_fov = 60;
  options.max_fov = 75;
  return rooms::random_camera(rooms::Room(seed), seed, options);
}

const View& first_view() {
  static const View view = room_view(rooms::Room(kRoom), first_camera());
  return view;
}

/// What a camera of that room sees from the first one's place, turned and moved in its own frame.
View seen_from(const Pose& motion, rooms::Camera camera = first_camera()) {
  const Pose pose = first_view().world_from_cam * motion;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) {
      camera.world_from_cam[4 * i + j] = static_cast<float>(pose(i, j));
    }
  }
  return room_view(rooms::Room(kRoom), camera);
}

Pose motion(double x, double y, double z, double turn, double roll = 0) {
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()))
                      .matrix();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

SecondPose find(const View& first, const View& second) {
  return find_second_pose(first, second.color, second.intrinsics, second.depth);
}

/// @return what the refusal says; empty when there is none
std::string refusal(const View& first, const Image& second, const Intrinsics& lens,
                    const Depth& depth = {}) {
  try {
    find_second_pose(first, second, lens, depth);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FindSecondPose, finds_a_second_photo_of_a_room_and_its_depth_scale) {
  View second = seen_from(motion(0.2, -0.05, 0.1, 0.1));
  second.depth *= 0.4f;
  const SecondPose found = find(first_view(), second);
  const PoseError error = pose_error(found.world_from_cam, second.world_from_cam);
  EXPECT_LT(error.degrees, 0.3);
  EXPECT_LT(error.metres, 0.02);
  EXPECT_NEAR(found.depth_scale, 2.5, 0.02);
  EXPECT_LT(found.depth_spread, 0.01);
  EXPECT_LT(found.reprojection_error, 1);
  EXPECT_LE(found.inliers, found.matches);
}

TEST(FindSecondPose, tolerates_guessed_depths) {
  const View second = seen_from(motion(0.25, -0.05, 0.1, 0.1));
  for (const std::uint64_t seed : {1, 2, 3}) {
    View first = first_view();
    first.depth = guessed_depth(first.depth, 0.15, seed);
    const SecondPose found = find(first, second);
    const PoseError error = pose_error(found.world_from_cam, second.world_from_cam);
    EXPECT_LT(error.degrees, 2) << seed;
    EXPECT_LT(error.metres, 0.15) << seed;
    EXPECT_GT(found.depth_spread, 0.02) << seed;
  }
}

TEST(FindSecondPose, the_same_photo_twice_is_in_the_same_place) {
  const SecondPose found = find(first_view(), first_view());
  const PoseError error = pose_error(found.world_from_cam, first_view().world_from_cam);
  EXPECT_LT(error.degrees, 0.1);
  EXPECT_LT(error.metres, 0.005);
  EXPECT_NEAR(found.depth_scale, 1, 1e-3);
}

TEST(FindSecondPose, a_turn_on_the_spot_has_no_baseline) {
  const View second = seen_from(motion(0, 0, 0, 0.2));
  View first = first_view();
  first.depth = guessed_depth(first.depth, 0.15, 4);
  for (const View& view : {first_view(), first}) {
    const PoseError error = pose_error(find(view, second).world_from_cam, second.world_from_cam);
    EXPECT_LT(error.degrees, 0.3);
    EXPECT_LT(error.metres, 0.03);
  }
}

TEST(FindSecondPose, a_photo_on_its_side_is_found) {
  const View second = seen_from(motion(0.1, 0, 0.05, 0.05, M_PI / 2));
  const PoseError error =
      pose_error(find(first_view(), second).world_from_cam, second.world_from_cam);
  EXPECT_LT(error.degrees, 0.4);
  EXPECT_LT(error.metres, 0.03);
}

TEST(FindSecondPose, sizes_and_lenses_may_differ) {
  rooms::Camera camera = first_camera();
  camera.width = 300;
  camera.height = 400;
  camera.fx = camera.fy = 1.2f * camera.fx;
  camera.cx = 140;
  camera.cy = 210;
  const View second = seen_from(motion(0.15, 0, 0, 0.05), camera);
  const PoseError there =
      pose_error(find(first_view(), second).world_from_cam, second.world_from_cam);
  EXPECT_LT(there.degrees, 0.4);
  EXPECT_LT(there.metres, 0.03);
  const PoseError back =
      pose_error(find(second, first_view()).world_from_cam, first_view().world_from_cam);
  EXPECT_LT(back.degrees, 0.4);
  EXPECT_LT(back.metres, 0.03);
}

TEST(FindSecondPose, holes_and_unsound_depths_are_passed_over) {
  View first = first_view();
  const View second = seen_from(motion(0.2, -0.05, 0.1, 0.1));
  first.depth = first.depth.clone();
  first.depth.colRange(0, 200) = 0;
  first.depth.colRange(300, 360) = std::numeric_limits<float>::quiet_NaN();
  const PoseError error = pose_error(find(first, second).world_from_cam, second.world_from_cam);
  EXPECT_LT(error.degrees, 0.5);
  EXPECT_LT(error.metres, 0.05);
}

TEST(FindSecondPose, without_a_second_depth_the_scale_is_1_and_the_spread_unknown) {
  const View second = seen_from(motion(0.2, -0.05, 0.1, 0.1));
  const SecondPose found = find_second_pose(first_view(), second.color, second.intrinsics);
  EXPECT_EQ(found.depth_scale, 1);
  EXPECT_TRUE(std::isnan(found.depth_spread));
}

TEST(FindSecondPose, gives_the_same_bytes_each_time_and_for_any_number_of_threads) {
  const View second = seen_from(motion(0.2, -0.05, 0.1, 0.1));
  const SecondPose once = find(first_view(), second);
  const int threads = cv::getNumThreads();
  cv::theRNG().state = 12345;
  for (const int count : {1, 2}) {
    cv::setNumThreads(count);
    const SecondPose again = find(first_view(), second);
    EXPECT_EQ(
        std::memcmp(again.world_from_cam.data(), once.world_from_cam.data(), 16 * sizeof(double)),
        0);
    EXPECT_EQ(again.inliers, once.inliers);
    EXPECT_EQ(again.depth_scale, once.depth_scale);
    EXPECT_EQ(again.depth_spread, once.depth_spread);
  }
  cv::setNumThreads(threads);
}

TEST(FindSecondPose, refuses_photos_of_other_rooms) {
  std::vector<View> views;
  for (std::uint64_t seed = 20; seed < 26; ++seed) {
    views.push_back(room_view(rooms::Room(seed), first_camera(seed)));
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < views.size(); ++j) {
      if (i == j) continue;
      EXPECT_NE(refusal(views[i], views[j].color, views[j].intrinsics), "") << i << " " << j;
    }
  }
}

TEST(FindSecondPose, a_refusal_says_what_is_wrong_and_what_would_be_right) {
  const View& first = first_view();
  const std::string flat =
      refusal(first, Image(360, 480, cv::Vec3f(0.4, 0.5, 0.6)), first.intrinsics);
  EXPECT_NE(flat.find("second photo: 0 of its 0 matches"), std::string::npos) << flat;
  EXPECT_NE(flat.find("--second-pose"), std::string::npos) << flat;
  EXPECT_NE(refusal(first, Image(1, 1, cv::Vec3f(1, 1, 1)), {1, 1, 1, 1, 0, 0}), "");
  EXPECT_NE(refusal(first, first.color(cv::Rect(100, 100, 15, 15)).clone(), {15, 15, 99, 99, 7, 7}),
            "");
}

TEST(FindSecondPose, refuses_what_lies_in_one_spot) {
  const View& first = first_view();
  // Of a large photo without anything else, the whole first photo is a spot.
  Image wall(8 * first.color.rows, 8 * first.color.cols, cv::Vec3f(0.5, 0.5, 0.5));
  first.color.copyTo(wall(cv::Rect(400, 300, first.color.cols, first.color.rows)));
  Intrinsics lens = first.intrinsics;
  lens.width = wall.cols;
  lens.height = wall.rows;
  lens.cx += 400;
  lens.cy += 300;
  const std::string says = refusal(first, wall, lens);
  EXPECT_NE(says.find("% of a photo"), std::string::npos) << says;
}

TEST(FindSecondPose, refuses_unsound_input) {
  const View& first = first_view();
  EXPECT_NE(refusal(View(), first.color, first.intrinsics), "");
  EXPECT_NE(refusal(first, Image(), first.intrinsics), "");
  EXPECT_NE(refusal(first, first.color, Intrinsics()), "");
  const std::string sizes = refusal(first, first.color, first.intrinsics, Depth(3, 4, 1.f));
  EXPECT_NE(sizes.find("differ in size"), std::string::npos) << sizes;
  const std::string unknown =
      refusal(first, first.color, first.intrinsics, Depth(first.depth.size(), 0.f));
  EXPECT_NE(unknown.find("depth"), std::string::npos) << unknown;
}

}  // namespace
}  // namespace ps
