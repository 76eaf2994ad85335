// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/relative_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/rooms/room.h"
#include "tests/support/pose_pairs.h"

namespace ps {
namespace {

/// Two views of each of some rooms, a step and a turn apart.
struct Pair {
  View first, second;
  double baseline() const {
    return (first.world_from_cam.translation() - second.world_from_cam.translation()).norm();
  }
};

std::vector<Pair> pairs_of_rooms(float turn, float shift) {
  std::vector<Pair> pairs;
  for (const std::uint64_t seed : {101, 102, 103, 104, 105}) {
    const rooms::Room room(seed);
    rooms::CameraOptions options;
    options.width = 320;
    options.height = 240;
    options.min_fov = 60;
    const rooms::Camera camera = rooms::random_camera(room, seed, options);
    pairs.push_back({room_view(room, camera),
                     room_view(room, rooms::moved(room, camera, seed + 7, turn, shift))});
  }
  return pairs;
}

SecondPose find(const View& first, const View& second) {
  return find_second_pose(first, second.color, second.intrinsics, second.depth);
}

TEST(RelativePose, is_found_from_true_depth) {
  int found = 0;
  for (const Pair& pair : pairs_of_rooms(0.3f, 0.4f)) {
    try {
      const SecondPose pose = find(pair.first, pair.second);
      const PoseError error = pose_error(pose.world_from_cam, pair.second.world_from_cam);
      EXPECT_LT(error.degrees, 1);
      EXPECT_LT(error.metres, 0.05);
      EXPECT_NEAR(pose.depth_scale, 1, 0.02);
      ++found;
    } catch (const Error&) {
      // A bare wall has nothing to be found by: it may be refused, but not be wrong.
    }
  }
  EXPECT_GE(found, 3) << "of 5";
}

TEST(RelativePose, directions_survive_a_guessed_depth_and_its_scale_is_told) {
  int found = 0;
  for (const Pair& pair : pairs_of_rooms(0.3f, 0.4f)) {
    View guessed = pair.first, other = pair.second;
    guessed.depth = guessed_depth(guessed.depth, 0.1, 3);
    other.depth = other.depth * 2.5;
    try {
      const SecondPose pose = find(guessed, other);
      EXPECT_LT(pose_error(pose.world_from_cam, pair.second.world_from_cam).degrees, 3);
      EXPECT_NEAR(pose.depth_scale, 0.4, 0.08);
      ++found;
    } catch (const Error&) {
    }
  }
  EXPECT_GE(found, 3) << "of 5";
}

TEST(RelativePose, the_same_photo_twice_is_the_same_pose) {
  int found = 0;
  for (const Pair& pair : pairs_of_rooms(0.3f, 0.4f)) {
    try {
      const SecondPose pose = find(pair.first, pair.first);
      const PoseError error = pose_error(pose.world_from_cam, pair.first.world_from_cam);
      EXPECT_LT(error.degrees, 0.1);
      EXPECT_LT(error.metres, 0.01);
      ++found;
    } catch (const Error&) {
    }
  }
  EXPECT_GE(found, 3) << "of 5";
}

TEST(RelativePose, unrelated_photos_are_refused) {
  const std::vector<Pair> pairs = pairs_of_rooms(0.3f, 0.4f);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (i == k) continue;
      EXPECT_THROW(find(pairs[i].first, pairs[k].second), Error) << i << " " << k;
    }
  }
}

TEST(RelativePose, photos_that_say_nothing_are_refused) {
  const Pair pair = pairs_of_rooms(0.3f, 0.4f).front();
  View flat = pair.second;
  flat.color.setTo(cv::Scalar::all(0.5));
  EXPECT_THROW(find(pair.first, flat), Error);
  View tiny = pair.second;
  tiny.intrinsics = resized(tiny.intrinsics, 8, 6);
  cv::resize(pair.second.color, tiny.color, {8, 6}, 0, 0, cv::INTER_AREA);
  tiny.depth = {};
  EXPECT_THROW(find(pair.first, tiny), Error);
  View misfit = pair.second;
  misfit.intrinsics.width = 10;
  EXPECT_THROW(find(pair.first, misfit), Error);
}

TEST(RelativePose, is_the_same_bytes_for_any_number_of_threads) {
  const Pair pair = pairs_of_rooms(0.3f, 0.4f).back();
  const auto matrix = [&](int count) {
    set_threads(count);
    cv::setNumThreads(count);
    try {
      return find(pair.first, pair.second).world_from_cam.matrix().eval();
    } catch (const Error&) {
      return Eigen::Matrix4d::Zero().eval();
    }
  };
  const Eigen::Matrix4d one = matrix(1), four = matrix(4);
  set_threads(0);
  cv::setNumThreads(-1);
  EXPECT_EQ(one, four);
}

}  // namespace
}  // namespace ps
