// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libps/core/error.h"
#include "libps/rooms/shot.h"

namespace ps::rooms {
namespace {

constexpr int kRoomsTried = 12;

std::array<double, 3> axis(const Camera& c, int k) {
  return {c.world_from_cam[k], c.world_from_cam[4 + k], c.world_from_cam[8 + k]};
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void expect_rigid(const Camera& c) {
  const auto x = axis(c, 0), y = axis(c, 1), z = axis(c, 2);
  for (const auto& a : {x, y, z}) EXPECT_NEAR(dot(a, a), 1, 1e-5);
  EXPECT_NEAR(dot(x, y), 0, 1e-5);
  EXPECT_NEAR(dot(y, z), 0, 1e-5);
  EXPECT_NEAR(dot(z, x), 0, 1e-5);
  const std::array<double, 3> cross = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                                       x[0] * y[1] - x[1] * y[0]};
  EXPECT_NEAR(dot(cross, z), 1, 1e-5);  // right-handed
}

/// The nearest surface, by six pictures that look all around.
float nearest_around(const Room& room, const Camera& camera) {
  const float sides[6][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1},  {-1, 0, 0, 0, 1, 0, 0, 0, -1},
                             {0, 0, 1, 0, 1, 0, -1, 0, 0}, {0, 0, -1, 0, 1, 0, 1, 0, 0},
                             {1, 0, 0, 0, 0, 1, 0, -1, 0}, {1, 0, 0, 0, 0, -1, 0, 1, 0}};
  float least = 1e9f;
  for (const auto& r : sides) {
    Camera c;
    c.width = c.height = 32;
    c.fx = c.fy = 16;
    c.cx = c.cy = 15.5f;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) c.world_from_cam[4 * i + j] = r[3 * i + j];
      c.world_from_cam[4 * i + 3] = camera.world_from_cam[4 * i + 3];
    }
    const std::vector<float> depth = shoot_depth(room, c);
    for (int i = 0; i < 32 * 32; ++i) {
      const float a = (static_cast<float>(i % 32) - c.cx) / c.fx;
      const float b = (static_cast<float>(i / 32) - c.cy) / c.fy;
      if (depth[i] > 0) least = std::min(least, depth[i] * std::sqrt(1 + a * a + b * b));
    }
  }
  return least;
}

TEST(RandomCamera, is_a_rigid_pose_in_free_space) {
  for (int seed = 0; seed < kRoomsTried; ++seed) {
    const Room room(seed);
    for (int k = 0; k < 3; ++k) {
      const Camera c = random_camera(room, 10 * seed + k);
      expect_rigid(c);
      EXPECT_TRUE(in_free_space(room, c, 0.08f));
      EXPECT_GT(nearest_around(room, c), 0.07f) << seed << " " << k;
    }
  }
}

TEST(RandomCamera, sees_no_more_than_a_little_of_what_is_at_its_nose) {
  int crowded = 0;
  for (int seed = 0; seed < kRoomsTried; ++seed) {
    const Room room(seed);
    const std::vector<float> depth = shoot_depth(room, random_camera(room, seed));
    const auto near =
        std::count_if(depth.begin(), depth.end(), [](float z) { return z > 0 && z < 0.5f; });
    crowded += near > static_cast<std::ptrdiff_t>(depth.size()) / 5 ? 1 : 0;
  }
  EXPECT_LE(crowded, 1);
}

TEST(RandomCamera, keeps_to_its_options) {
  CameraOptions o;
  o.width = 90;
  o.height = 60;
  o.min_fov = o.max_fov = 57;
  o.min_height = 0.9f;
  o.max_height = 1.1f;
  o.max_pitch = 10;
  o.max_roll = 2;
  const Room room(5);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Camera c = random_camera(room, seed, o);
    EXPECT_EQ(c.width, 90);
    EXPECT_EQ(c.height, 60);
    EXPECT_NEAR(2 * std::atan(45 / c.fx) * 180 / M_PI, 57, 0.01);
    EXPECT_EQ(c.fx, c.fy);
    EXPECT_GE(c.world_from_cam[7], 0.899f);
    EXPECT_LE(c.world_from_cam[7], 1.101f);
    const double degree = M_PI / 180;
    EXPECT_LE(std::abs(axis(c, 2)[1]), std::sin(10.01 * degree));
    EXPECT_LE(std::abs(axis(c, 0)[1]), std::sin(2.01 * degree));
    EXPECT_LT(axis(c, 1)[1], 0);  // y points down
  }
}

TEST(RandomCamera, refuses_options_that_leave_none) {
  const Room room(5);
  CameraOptions o;
  o.width = 0;
  EXPECT_THROW(random_camera(room, 1, o), Error);
  o = {};
  o.min_fov = 100;
  o.max_fov = 50;
  EXPECT_THROW(random_camera(room, 1, o), Error);
  o = {};
  o.min_height = 50;
  o.max_height = 60;
  EXPECT_THROW(random_camera(room, 1, o), Error);
}

TEST(Moved, stays_within_its_limits_and_in_free_space) {
  double largest_turn = 0, largest_step = 0;
  for (int seed = 0; seed < kRoomsTried; ++seed) {
    const Room room(seed);
    const Camera a = random_camera(room, seed);
    for (int k = 0; k < 4; ++k) {
      const Camera b = moved(room, a, 100 * seed + k, 0.5f, 0.4f);
      expect_rigid(b);
      double trace = 0, step = 0;
      for (int i = 0; i < 3; ++i) {
        trace += dot(axis(a, i), axis(b, i));
        step += std::pow(b.world_from_cam[4 * i + 3] - a.world_from_cam[4 * i + 3], 2);
      }
      const double turn = std::acos(std::clamp((trace - 1) / 2, -1., 1.));
      EXPECT_LE(turn, 0.501);
      EXPECT_LE(std::sqrt(step), 0.401);
      EXPECT_TRUE(step == 0 || in_free_space(room, b, 0.1f));
      EXPECT_EQ(b.fx, a.fx);
      largest_turn = std::max(largest_turn, turn);
      largest_step = std::max(largest_step, std::sqrt(step));
    }
  }
  EXPECT_GT(largest_turn, 0.3);
  EXPECT_GT(largest_step, 0.2);
}

TEST(InFreeSpace, is_not_in_walls_floors_or_the_open) {
  const Room room(7);
  Camera c = random_camera(room, 1);
  c.world_from_cam[7] = 0.05f;
  EXPECT_FALSE(in_free_space(room, c));
  c.world_from_cam[7] = 50;
  EXPECT_FALSE(in_free_space(room, c));
  c.world_from_cam[7] = 1.5f;
  c.world_from_cam[3] = room.bounds()[0][0] + 0.1f;
  EXPECT_FALSE(in_free_space(room, c));
}

}  // namespace
}  // namespace ps::rooms
