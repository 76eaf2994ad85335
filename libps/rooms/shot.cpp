// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/shot.h"

#include <string>

#include "libps/core/error.h"
#include "libps/rooms/shooter.h"
#include "libps/rooms/view_rays.h"

namespace ps::rooms {
namespace {

constexpr int kLargest = 16384;

void check(const Camera& c) {
  if (c.width <= 0 || c.height <= 0 || c.width > kLargest || c.height > kLargest) {
    throw Error("camera size", std::to_string(c.width) + "x" + std::to_string(c.height),
                "1 to 16384 pixels");
  }
  if (!(c.fx > 0) || !(c.fy > 0)) {
    throw Error("camera", "a focal length is not positive", "pixels");
  }
}

}  // namespace

Shot shoot(const Room& room, const Camera& camera) {
  check(camera);
  return Shooter(room.scene(), camera).shoot();
}

std::vector<float> shoot_depth(const Room& room, const Camera& camera) {
  check(camera);
  std::vector<float> depth(static_cast<std::size_t>(camera.width) * camera.height);
  for (int y = 0; y < camera.height; y += kSide) {
    for (int x = 0; x < camera.width; x += kSide) {
      Rays rays;
      block_rays(camera, x, y, rays);
      room.scene().nearest(rays);
      for (int k = 0; k < kRays; ++k) {
        if (rays.face[k] < 0) continue;
        depth[static_cast<std::size_t>(y + k / kSide) * camera.width + x + k % kSide] =
            rays.reach[k];
      }
    }
  }
  return depth;
}

std::vector<std::uint8_t> seen_from(const Room& room, const Camera& a, const Camera& b,
                                    const std::vector<float>& depth_b) {
  check(a);
  check(b);
  const std::size_t n = static_cast<std::size_t>(b.width) * b.height;
  if (depth_b.size() != n) {
    throw Error("seen_from", std::to_string(depth_b.size()) + " depths", std::to_string(n));
  }
  std::vector<std::uint8_t> seen(n);
  const Vec eye_a = eye_of(a), eye_b = eye_of(b);
  for (std::size_t first = 0; first < n; first += kRays) {
    Rays rays;
    clear(rays);
    for (int k = 0; k < kRays && first + k < n; ++k) {
      const std::size_t i = first + k;
      if (!(depth_b[i] > 0)) continue;
      const Vec p =
          eye_b +
          ray_of(b, static_cast<float>(i % b.width), static_cast<float>(i / b.width)) * depth_b[i];
      const Vec in_a = to_camera(a, p);
      if (in_a.z <= 1e-3f) continue;
      const float x = in_a.x / in_a.z * a.fx + a.cx, y = in_a.y / in_a.z * a.fy + a.cy;
      if (x < -0.5f || y < -0.5f || x > static_cast<float>(a.width) - 0.5f ||
          y > static_cast<float>(a.height) - 0.5f) {
        continue;
      }
      set_ray(rays, k, eye_a, p - eye_a, 1 - std::max(1e-3f, 2e-3f / length(p - eye_a)));
      seen[i] = 1;
    }
    room.scene().nearest(rays);  // lamps block the view, if not the light
    for (int k = 0; k < kRays && first + k < n; ++k) {
      if (rays.face[k] >= 0) seen[first + k] = 0;
    }
  }
  return seen;
}

}  // namespace ps::rooms
