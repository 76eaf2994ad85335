// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include "libps/rooms/camera.h"
#include "libps/rooms/vec.h"

namespace ps::rooms {

constexpr float kFarthest = 1000;  ///< metres

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

inline Vec to_camera(const Camera& c, Vec point) {
  const auto& m = c.world_from_cam;
  const Vec d = point - eye_of(c);
  return {m[0] * d.x + m[4] * d.y + m[8] * d.z, m[1] * d.x + m[5] * d.y + m[9] * d.z,
          m[2] * d.x + m[6] * d.y + m[10] * d.z};
}

}  // namespace ps::rooms
