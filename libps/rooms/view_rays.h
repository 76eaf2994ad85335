// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include "libps/rooms/camera.h"
#include "libps/rooms/tree.h"
#include "libps/rooms/vec.h"

namespace ps::rooms {

constexpr float kFarthest = 1000;  ///< metres
constexpr int kSide = 4;           ///< a packet is 4x4 pixels

inline Vec eye_of(const Camera& c) {
  return {c.world_from_cam[3], c.world_from_cam[7], c.world_from_cam[11]};
}

/// Through the middle of pixel (x, y), one metre deep: its multiple at a surface is the depth.
inline Vec ray_of(const Camera& c, float x, float y) {
  const auto& m = c.world_from_cam;
  const Vec d{(x - c.cx) / c.fx, (y - c.cy) / c.fy, 1};
  return {m[0] * d.x + m[1] * d.y + m[2] * d.z, m[4] * d.x + m[5] * d.y + m[6] * d.z,
          m[8] * d.x + m[9] * d.y + m[10] * d.z};
}

/// Rays of the 4x4 pixels from (x0, y0) on that lie in the picture.
inline void block_rays(const Camera& c, int x0, int y0, Rays& rays) {
  clear(rays);
  const Vec eye = eye_of(c);
  for (int k = 0; k < kRays; ++k) {
    const int x = x0 + k % kSide, y = y0 + k / kSide;
    if (x >= c.width || y >= c.height) continue;
    set_ray(rays, k, eye, ray_of(c, static_cast<float>(x), static_cast<float>(y)), kFarthest);
  }
}

inline Vec direction_of(const Rays& rays, int i) {
  return {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]};
}

inline Vec to_camera(const Camera& c, Vec point) {
  const auto& m = c.world_from_cam;
  const Vec d = point - eye_of(c);
  return {m[0] * d.x + m[4] * d.y + m[8] * d.z, m[1] * d.x + m[5] * d.y + m[9] * d.z,
          m[2] * d.x + m[6] * d.y + m[10] * d.z};
}

}  // namespace ps::rooms
