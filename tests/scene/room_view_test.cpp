// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/room_view.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"

namespace ps {
namespace {

rooms::Camera small_camera() {
  rooms::Camera camera;
  camera.width = 3;
  camera.height = 2;
  camera.fx = camera.fy = 3;
  camera.cx = 1;
  camera.cy = .5f;
  return camera;
}

rooms::Shot numbered_shot() {
  rooms::Shot shot;
  shot.width = 3;
  shot.height = 2;
  for (int i = 0; i < 18; ++i) shot.color.push_back(static_cast<float>(i));
  for (int i = 0; i < 6; ++i) shot.depth.push_back(static_cast<float>(10 + i));
  return shot;
}

TEST(RoomView, has_the_pixels_of_the_shot_and_the_lens_of_its_camera) {
  const View view = view_of(numbered_shot(), small_camera());
  EXPECT_EQ(view.color(1, 2), cv::Vec3f(15, 16, 17));
  EXPECT_EQ(view.depth(1, 0), 13);
  EXPECT_EQ(view.intrinsics.width, 3);
  EXPECT_EQ(view.intrinsics.height, 2);
  EXPECT_EQ(view.intrinsics.fx, 3);
}

TEST(RoomView, of_a_shot_of_several_sizes_or_of_another_camera_is_refused) {
  rooms::Shot shot = numbered_shot();
  shot.color.push_back(0);
  EXPECT_THROW(view_of(shot, small_camera()), Error);
  shot = numbered_shot();
  shot.depth.pop_back();
  EXPECT_THROW(view_of(shot, small_camera()), Error);
  rooms::Camera camera = small_camera();
  std::swap(camera.width, camera.height);
  EXPECT_THROW(view_of(numbered_shot(), camera), Error);
  EXPECT_THROW(view_of({}, {}), Error);
}

TEST(RoomView, rooms_of_seeds_are_counted_on_and_apart) {
  EXPECT_EQ(room_number(0, 5), 5u);
  EXPECT_EQ(room_number(7, 3), 7000003u);
  EXPECT_LT(room_number(7, kRoomsOfSeed - 1), room_number(8, 0));
}

}  // namespace
}  // namespace ps
