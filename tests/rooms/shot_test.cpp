// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/shot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps::rooms {
namespace {

Camera camera_of(const Room& room, std::uint64_t seed, int width = 64, int height = 48) {
  CameraOptions o;
  o.width = width;
  o.height = height;
  return random_camera(room, seed, o);
}

std::array<double, 3> world_of(const Camera& c, double x, double y, double z) {
  const double p[3] = {(x - c.cx) / c.fx * z, (y - c.cy) / c.fy * z, z};
  std::array<double, 3> w{};
  for (int i = 0; i < 3; ++i) {
    w[i] = c.world_from_cam[4 * i + 3];
    for (int j = 0; j < 3; ++j) w[i] += c.world_from_cam[4 * i + j] * p[j];
  }
  return w;
}

/// Pixel coordinates and depth.
std::array<double, 3> project(const Camera& c, const std::array<double, 3>& w) {
  double p[3] = {};
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      p[j] += c.world_from_cam[4 * i + j] * (w[i] - c.world_from_cam[4 * i + 3]);
    }
  }
  return {p[0] / p[2] * c.fx + c.cx, p[1] / p[2] * c.fy + c.cy, p[2]};
}

TEST(Shoot, gives_depths_that_are_finite_and_colours_that_can_be_shown) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Room room(seed);
    const Shot shot = shoot(room, camera_of(room, seed, 61, 43));
    EXPECT_EQ(shot.width, 61);
    EXPECT_EQ(shot.height, 43);
    ASSERT_EQ(shot.depth.size(), 61u * 43);
    ASSERT_EQ(shot.color.size(), 61u * 43 * 3);
    for (const float z : shot.depth) EXPECT_TRUE(std::isfinite(z) && z >= 0 && z < 100);
    for (const float c : shot.color) EXPECT_TRUE(c >= 0 && c <= 1);
    const auto [dark, bright] = std::minmax_element(shot.color.begin(), shot.color.end());
    EXPECT_GT(*bright - *dark, 0.05f) << seed;
  }
}

TEST(Shoot, is_the_same_on_every_thread) {
  const Room room(11);
  const Camera camera = camera_of(room, 4);
  const Shot alone = shoot(room, camera);
  std::vector<Shot> shots(6);
  set_threads(3);
  parallel_for(shots.size(), [&](std::size_t i) { shots[i] = shoot(room, camera); });
  set_threads(0);
  for (const Shot& s : shots) {
    EXPECT_EQ(s.color, alone.color);
    EXPECT_EQ(s.depth, alone.depth);
  }
}

TEST(Shoot, has_the_depth_of_shoot_depth) {
  const Room room(12);
  const Camera camera = camera_of(room, 2);
  EXPECT_EQ(shoot(room, camera).depth, shoot_depth(room, camera));
}

TEST(Shoot, measures_the_floor_along_the_optical_axis) {
  // Straight down every pixel of the floor is as deep as the camera is high, and nothing is deeper.
  int floor_pixels = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Room room(seed);
    Camera c = camera_of(room, seed);
    const float eye[3] = {c.world_from_cam[3], c.world_from_cam[7], c.world_from_cam[11]};
    c.world_from_cam = {1, 0, 0, eye[0], 0, 0, -1, eye[1], 0, 1, 0, eye[2]};
    for (const float z : shoot_depth(room, c)) {
      EXPECT_LE(z, eye[1] * (1 + 2e-6f));
      floor_pixels += std::abs(z - eye[1]) < 2e-6f * eye[1] ? 1 : 0;
    }
  }
  EXPECT_GT(floor_pixels, 8 * 64 * 48 / 5);
}

TEST(Shoot, measures_the_ceiling_too) {
  int ceiling_pixels = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Room room(seed);
    const float height = room.bounds()[1][1];
    Camera c = camera_of(room, seed);
    const float eye[3] = {c.world_from_cam[3], c.world_from_cam[7], c.world_from_cam[11]};
    c.world_from_cam = {1, 0, 0, eye[0], 0, 0, 1, eye[1], 0, -1, 0, eye[2]};
    for (const float z : shoot_depth(room, c)) {
      ceiling_pixels += std::abs(z + eye[1] - height) < 3e-6f * height ? 1 : 0;
    }
  }
  EXPECT_GT(ceiling_pixels, 8 * 64 * 48 / 5);
}

TEST(Shoot, refuses_a_camera_that_is_none) {
  const Room room(1);
  Camera c = camera_of(room, 1);
  c.fx = 0;
  EXPECT_THROW(shoot(room, c), Error);
  c = camera_of(room, 1);
  c.height = -1;
  EXPECT_THROW(shoot_depth(room, c), Error);
}

TEST(SeenFrom, means_that_the_other_view_has_that_very_point) {
  int compared = 0, seen_pixels = 0, pixels = 0;
  std::vector<float> differences;
  for (std::uint64_t seed = 30; seed < 36; ++seed) {
    const Room room(seed);
    const Camera a = camera_of(room, seed, 128, 96), b = moved(room, a, seed, 0.2f, 0.3f);
    const Shot shot_a = shoot(room, a), shot_b = shoot(room, b);
    const std::vector<std::uint8_t> seen = seen_from(room, a, b, shot_b.depth);
    for (int i = 0; i < 128 * 96; ++i) {
      ++pixels;
      seen_pixels += seen[i];
      if (!seen[i] || i % 37 != 0) continue;
      const auto p = project(a, world_of(b, i % 128, i / 128, shot_b.depth[i]));
      // A picture of one pixel, just there.
      Camera one = a;
      one.width = one.height = 1;
      one.cx = static_cast<float>(a.cx - p[0]);
      one.cy = static_cast<float>(a.cy - p[1]);
      // Beyond a grazed edge one ray may slip past: half a per cent of rays is forgiven below.
      differences.push_back(std::abs(shoot_depth(room, one)[0] / static_cast<float>(p[2]) - 1));
      ++compared;
    }
  }
  ASSERT_GT(compared, 500);
  EXPECT_GT(seen_pixels, pixels / 3);
  std::sort(differences.begin(), differences.end());
  EXPECT_LT(differences[differences.size() * 995 / 1000], 1e-3f);
}

TEST(SeenFrom, colours_agree_where_a_point_is_seen_twice) {
  std::vector<float> differences;
  for (std::uint64_t seed = 40; seed < 46; ++seed) {
    const Room room(seed);
    const Camera a = camera_of(room, seed, 128, 96), b = moved(room, a, seed, 0.15f, 0.2f);
    const Shot shot_a = shoot(room, a), shot_b = shoot(room, b);
    const std::vector<std::uint8_t> seen = seen_from(room, a, b, shot_b.depth);
    for (int i = 0; i < 128 * 96; ++i) {
      if (!seen[i]) continue;
      const auto p = project(a, world_of(b, i % 128, i / 128, shot_b.depth[i]));
      const int x = std::clamp(static_cast<int>(std::lround(p[0])), 0, 127);
      const int y = std::clamp(static_cast<int>(std::lround(p[1])), 0, 95);
      for (int c = 0; c < 3; ++c) {
        differences.push_back(
            std::abs(shot_a.color[3 * (y * 128 + x) + c] - shot_b.color[3 * i + c]));
      }
    }
  }
  ASSERT_GT(differences.size(), 10000u);
  std::sort(differences.begin(), differences.end());
  EXPECT_LT(differences[differences.size() / 2], 0.02f);
  EXPECT_LT(differences[differences.size() * 8 / 10], 0.08f);
}

TEST(SeenFrom, denies_what_lies_behind_a_surface) {
  const Room room(13);
  const Camera c = camera_of(room, 3);
  const std::vector<float> depth = shoot_depth(room, c);
  std::vector<float> behind = depth, before = depth;
  for (float& z : behind) z *= 1.2f;
  for (float& z : before) z *= 0.98f;
  const auto of_surface = seen_from(room, c, c, depth), of_behind = seen_from(room, c, c, behind),
             of_before = seen_from(room, c, c, before);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    EXPECT_EQ(of_surface[i], depth[i] > 0 ? 1 : 0);
    EXPECT_EQ(of_before[i], depth[i] > 0 ? 1 : 0);
    EXPECT_EQ(of_behind[i], 0);
  }
}

TEST(SeenFrom, denies_what_lies_outside_of_the_picture) {
  const Room room(13);
  const Camera b = camera_of(room, 3);
  Camera a = b;  // turned about: x and z the other way
  for (const int k : {0, 2, 4, 6, 8, 10}) a.world_from_cam[k] = -a.world_from_cam[k];
  for (const std::uint8_t s : seen_from(room, a, b, shoot_depth(room, b))) EXPECT_EQ(s, 0);
  EXPECT_THROW(seen_from(room, a, b, {1, 2, 3}), Error);
}

}  // namespace
}  // namespace ps::rooms
