// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/rooms/shot.h"

namespace ps::rooms {
namespace {

Camera small_camera(const Room& room, std::uint64_t seed) {
  CameraOptions options;
  options.width = 48;
  options.height = 32;
  return random_camera(room, seed, options);
}

/// A crate of this size, its base on the floor.
Model crate(float width, float height, float depth) {
  Model m;
  m.name = "crate";
  m.category = "Miscellaneous";
  for (int c = 0; c < 8; ++c) {
    m.positions.push_back(
        {(c & 1 ? 0.5f : -0.5f) * width, c & 2 ? height : 0, (c & 4 ? 0.5f : -0.5f) * depth});
  }
  const std::uint32_t quads[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    m.triangles.push_back({{q[0], q[1], q[2]}, 0});
    m.triangles.push_back({{q[0], q[2], q[3]}, 0});
  }
  m.materials.push_back({{1, 0, 0}, 1, -1});
  return m;
}

std::vector<Model> crates() {
  std::vector<Model> all;
  for (const float w : {0.3f, 0.5f, 0.8f, 1.2f, 1.8f}) {
    for (const float h : {0.5f, 0.9f, 1.8f}) {
      for (const float d : {0.3f, 0.5f, 0.8f}) all.push_back(crate(w, h, d));
    }
  }
  return all;
}

TEST(Room, is_a_function_of_its_seed) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Room a(seed), b(seed);
    EXPECT_EQ(a.kind(), b.kind());
    EXPECT_EQ(a.bounds(), b.bounds());
    const Camera camera = small_camera(a, seed);
    EXPECT_EQ(camera.world_from_cam, small_camera(b, seed).world_from_cam);
    EXPECT_EQ(shoot(a, camera).color, shoot(b, camera).color);
    EXPECT_EQ(shoot(a, camera).depth, shoot(b, camera).depth);
  }
}

TEST(Room, of_another_seed_is_another_room) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    EXPECT_NE(Room(seed).bounds(), Room(seed + 1).bounds());
  }
  // Seeds that differ in their upper half alone, too.
  EXPECT_NE(Room(1).bounds(), Room(1 + (std::uint64_t{1} << 32)).bounds());
}

TEST(Room, is_of_each_kind_now_and_then) {
  constexpr int kMany = 64;
  std::array<int, kRoomKinds> count{};
  for (int seed = 0; seed < kMany; ++seed) ++count[static_cast<int>(Room(seed).kind())];
  for (int k = 0; k < kRoomKinds; ++k) {
    EXPECT_GT(count[k], 0) << to_string(static_cast<RoomKind>(k));
    EXPECT_LT(count[k], kMany / 2) << to_string(static_cast<RoomKind>(k));
  }
}

TEST(Room, is_as_large_as_rooms_are) {
  for (std::uint64_t seed = 20; seed < 40; ++seed) {
    const auto b = Room(seed).bounds();
    EXPECT_EQ(b[0][1], 0);
    EXPECT_GT(b[1][1], 2);
    EXPECT_LT(b[1][1], 6);
    for (const int axis : {0, 2}) {
      EXPECT_GT(b[1][axis] - b[0][axis], 1);
      EXPECT_LT(b[1][axis] - b[0][axis], 20);
    }
  }
}

TEST(Furniture, stands_in_rooms_that_are_given_it) {
  const Furniture furniture(crates());
  EXPECT_EQ(furniture.size(), crates().size());
  RoomOptions options;
  options.furniture = &furniture;
  int changed = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Room with(seed, options), without(seed);
    const Camera camera = small_camera(without, seed);
    changed += shoot(with, camera).depth != shoot(without, camera).depth ? 1 : 0;
    EXPECT_EQ(shoot(with, camera).color, shoot(Room(seed, options), camera).color);
  }
  EXPECT_GE(changed, 3);
}

TEST(Furniture, may_be_used_first_by_many_threads_at_once) {
  const auto depth_in = [](const Furniture& furniture) {
    RoomOptions options;
    options.furniture = &furniture;
    const Room room(2, options);
    return shoot_depth(room, small_camera(room, 1));
  };
  const Furniture shared(crates());
  std::vector<std::vector<float>> depths(6);
  set_threads(3);
  parallel_for(depths.size(), [&](std::size_t i) { depths[i] = depth_in(shared); });
  set_threads(0);
  const std::vector<float> alone = depth_in(Furniture(crates()));
  for (const auto& depth : depths) EXPECT_EQ(depth, alone);
}

TEST(Furniture, may_be_forgotten_once_its_room_is_built) {
  Camera camera;
  std::vector<float> depth;
  const auto furnished = [] {
    const Furniture furniture(crates());
    RoomOptions options;
    options.furniture = &furniture;
    return Room(2, options);
  };
  const Room room = furnished(), again = furnished();
  camera = small_camera(room, 1);
  EXPECT_EQ(shoot_depth(room, camera), shoot_depth(again, camera));
}

TEST(Furniture, without_a_triangle_to_show_is_never_placed) {
  std::vector<Model> models = {Model{}, crate(1, 1, 0), crate(1, 1, 1)};
  models[0].name = "nothing";
  for (auto& p : models[1].positions) p = {0, 0, 0};  // no area
  models[2].materials[0].opacity = 0.1f;
  const Furniture furniture(models);
  EXPECT_EQ(furniture.size(), 0u);
  RoomOptions options;
  options.furniture = &furniture;
  const Room with(3, options), without(3);
  const Camera camera = small_camera(without, 3);
  EXPECT_NO_THROW(shoot(with, camera));
}

TEST(Furniture, skips_a_triangle_without_area) {
  Model m = crate(1, 1, 1);
  m.triangles.push_back({{0, 0, 1}, 0});
  m.triangles.push_back({{2, 2, 2}, 0});
  EXPECT_EQ(Furniture({m}).size(), 1u);
}

TEST(Furniture, that_is_broken_is_refused_by_name) {
  const auto expect_refused = [](const Model& m) {
    try {
      Furniture({m});
      FAIL() << "not refused";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("crate"), std::string::npos) << e.what();
    }
  };
  Model m = crate(1, 1, 1);
  m.triangles[3].corners[1] = 8;
  expect_refused(m);
  m = crate(1, 1, 1);
  m.triangles[0].material = 1;
  expect_refused(m);
  m = crate(1, 1, 1);
  m.materials[0].texture = 0;
  expect_refused(m);
  m = crate(1, 1, 1);
  m.uvs.resize(3);
  expect_refused(m);
  m = crate(1, 1, 1);
  m.positions[2][1] = std::numeric_limits<float>::quiet_NaN();
  expect_refused(m);
  m = crate(1, 1, 1);
  m.textures.push_back({2, 2, std::vector<std::uint8_t>(11)});
  expect_refused(m);
}

}  // namespace
}  // namespace ps::rooms
