// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/camera.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libps/core/error.h"
#include "libps/rooms/dice.h"
#include "libps/rooms/scene.h"
#include "libps/rooms/view_rays.h"

namespace ps::rooms {
namespace {

constexpr float kDegree = 0.01745329f;
constexpr int kAttempts = 60;
constexpr int kGlance = 16;  ///< side of the small picture that a view is judged by

/// Columns of the rotation are the camera's axes.
void set_pose(Camera& c, Vec right, Vec down, Vec forward, Vec eye) {
  c.world_from_cam = {right.x,   down.x, forward.x, eye.x,  right.y,   down.y,
                      forward.y, eye.y,  right.z,   down.z, forward.z, eye.z};
}

/// Looks along `yaw` (0 = against z), up by `pitch`.
void aim(Camera& c, Vec eye, float yaw, float pitch, float roll) {
  const Vec forward{std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                    -std::cos(yaw) * std::cos(pitch)};
  const Vec level{std::cos(yaw), 0, std::sin(yaw)};
  const Vec under = cross(forward, level);  // right-handed: right, down, forward
  const Vec right = level * std::cos(roll) + under * std::sin(roll);
  set_pose(c, right, cross(forward, right), forward, eye);
}

/// A small picture to judge a view by.
struct Glance {
  std::vector<float> depth = std::vector<float>(kGlance * kGlance);
  int materials = 0;  ///< how many kinds of surface are seen
};

Glance glance(const Scene& scene, const Camera& c) {
  Glance g;
  std::vector<const Material*> seen;
  const Vec eye = eye_of(c);
  for (int b = 0; b < kGlance * kGlance / kRays; ++b) {
    Rays rays;
    clear(rays);
    for (int k = 0; k < kRays; ++k) {
      const int x = b % 4 * 4 + k % 4, y = b / 4 * 4 + k / 4;
      set_ray(
          rays, k, eye,
          ray_of(c, (static_cast<float>(x) + 0.5f) / kGlance * static_cast<float>(c.width) - 0.5f,
                 (static_cast<float>(y) + 0.5f) / kGlance * static_cast<float>(c.height) - 0.5f),
          kFarthest);
    }
    scene.nearest(rays);
    for (int k = 0; k < kRays; ++k) {
      const int x = b % 4 * 4 + k % 4, y = b / 4 * 4 + k / 4;
      g.depth[y * kGlance + x] = rays.face[k] < 0 ? 0 : rays.reach[k];
      if (rays.face[k] < 0) continue;
      const Part& part = scene.parts[rays.part[k]];
      seen.push_back(&(*part.materials)[part.mesh->faces[rays.face[k]].material]);
    }
  }
  std::sort(seen.begin(), seen.end());
  g.materials = static_cast<int>(std::unique(seen.begin(), seen.end()) - seen.begin());
  return g;
}

/// Whether somebody would take this photo: walls at the nose, sky, and views of nothing are rare.
bool worth_a_photo(const Scene& scene, const Camera& c, Dice& d) {
  Glance g = glance(scene, c);
  std::vector<float>& depth = g.depth;
  int near = 0, outside = 0, steps = 0;
  for (int y = 0; y < kGlance; ++y) {
    for (int x = 0; x < kGlance; ++x) {
      const float z = depth[y * kGlance + x];
      near += z > 0 && z < 0.5f ? 1 : 0;
      outside += z == 0 ? 1 : 0;
      if (x > 0 && std::abs(z - depth[y * kGlance + x - 1]) > 0.15f * z) ++steps;
    }
  }
  const int all = kGlance * kGlance;
  std::nth_element(depth.begin(), depth.begin() + all / 2, depth.end());
  const float median = depth[all / 2];
  if (near > all / 8 || outside > all / 4 || median < 0.7f) return false;
  if (median < 1.8f && !d.chance(median < 1.3f ? 0.2f : 0.5f)) return false;
  if (g.materials < 7 && !d.chance(g.materials < 4 ? 0.15f : 0.4f)) return false;
  return steps > all / 20 || d.chance(0.3f);
}

void check(const CameraOptions& o) {
  if (o.width <= 0 || o.height <= 0) throw Error("camera size", "not positive", "pixels");
  if (!(o.min_fov > 1) || !(o.max_fov < 170) || o.min_fov > o.max_fov) {
    throw Error("camera field of view",
                std::to_string(o.min_fov) + " to " + std::to_string(o.max_fov),
                "1 to 170 degrees, the smaller first");
  }
  if (!(o.min_height > 0) || o.min_height > o.max_height) {
    throw Error("camera heights",
                std::to_string(o.min_height) + " to " + std::to_string(o.max_height),
                "above 0 m, the lower first");
  }
}

/// A small random number, now and then a large one, within +-1.
float mostly_small(Dice& d) {
  return d.chance(0.75f) ? std::clamp(d.normal() * 0.25f, -1.f, 1.f) : d.range(-1, 1);
}

}  // namespace

bool in_free_space(const Room& room, const Camera& camera, float clearance) {
  const Scene& scene = room.scene();
  const Vec eye = eye_of(camera);
  bool inside = false;
  for (const Space& s : scene.spaces) inside |= s.holds(eye, -clearance * 0.9f);
  if (!inside) return false;
  for (int packet = 0; packet < 4; ++packet) {
    Rays rays;
    clear(rays);
    for (int i = 0; i < kRays; ++i) {
      const float k = static_cast<float>(packet * kRays + i);
      const float z = 1 - (2 * k + 1) / (4 * kRays), r = std::sqrt(1 - z * z), a = 2.3999632f * k;
      set_ray(rays, i, eye, {r * std::cos(a), z, r * std::sin(a)}, clearance);
    }
    scene.nearest(rays);
    for (int i = 0; i < kRays; ++i) {
      if (rays.face[i] >= 0) return false;
    }
  }
  return !scene.inside_thing(eye);
}

Camera random_camera(const Room& room, std::uint64_t seed, const CameraOptions& o) {
  check(o);
  Dice d(seed, 2);
  const Scene& scene = room.scene();
  Camera c, last;
  bool found = false;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const float fov = (d.chance(0.5f) ? d.range(50, 75) : d.range(o.min_fov, o.max_fov));
    c.width = o.width;
    c.height = o.height;
    c.fx = c.fy = 0.5f * static_cast<float>(o.width) /
                  std::tan(0.5f * std::clamp(fov, o.min_fov, o.max_fov) * kDegree);
    c.cx = 0.5f * static_cast<float>(o.width - 1);
    c.cy = 0.5f * static_cast<float>(o.height - 1);
    const std::size_t n = scene.spaces.size();
    const Space& s = scene.spaces[d.chance(0.85f) ? 0 : d.below(static_cast<int>(n))];
    const Rect& r = s.rects[d.below(static_cast<int>(s.rects.size()))];
    const float low = std::max(o.min_height, 0.05f), high = std::min(o.max_height, s.height - 0.1f);
    if (low > high)
      throw Error("camera heights", "all above the ceiling",
                  "below " + std::to_string(s.height) + " m");
    const float height = std::clamp(
        d.chance(0.75f) ? d.range(1, 1.7f) : d.range(o.min_height, o.max_height), low, high);
    const Vec eye{d.range(r.x0, r.x1), height, d.range(r.z0, r.z1)};
    // People look down at things more than up; the more so the higher they stand.
    const float down = d.range(0, 0.6f) * std::clamp(height - 0.5f, -0.2f, 1.f);
    const float pitch = (mostly_small(d) - down) * o.max_pitch;
    aim(c, eye, d.range(0, 6.2831853f), std::clamp(pitch, -o.max_pitch, o.max_pitch) * kDegree,
        mostly_small(d) * o.max_roll * kDegree);
    if (!in_free_space(room, c, 0.25f)) continue;
    last = c;
    found = true;
    if (worth_a_photo(scene, c, d)) return c;
  }
  if (found) return last;
  // A crowded room: the freest of many places just above the floor's middle.
  const Space& s = scene.spaces[0];
  for (int attempt = 0; attempt < 400; ++attempt) {
    const Rect& r = s.rects[d.below(static_cast<int>(s.rects.size()))];
    const float high = std::min(o.max_height, s.height - 0.1f);
    aim(c, {d.range(r.x0, r.x1), d.range(std::min(o.min_height, high), high), d.range(r.z0, r.z1)},
        d.range(0, 6.28f), 0, 0);
    if (in_free_space(room, c, attempt < 200 ? 0.15f : 0.08f)) return c;
  }
  throw Error("camera", "this room has no free place", "other heights");
}

Camera moved(const Room& room, const Camera& camera, std::uint64_t seed, float max_rotation,
             float max_translation) {
  Dice d(seed, 3);
  const auto& m = camera.world_from_cam;
  const Vec right{m[0], m[4], m[8]}, down{m[1], m[5], m[9]}, forward{m[2], m[6], m[10]};
  const Vec eye = eye_of(camera);
  const auto turn = [&](Vec v, Vec axis, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
  };
  Camera out = camera;
  for (int attempt = 0; attempt < 30; ++attempt) {
    const bool stay = attempt == 29;
    const Vec up{0.3f * d.normal(), 1, 0.3f * d.normal()}, any{d.normal(), d.normal(), d.normal()};
    const Vec axis = normalized(d.chance(0.7f) ? up : any);
    const float angle = d.range(-max_rotation, max_rotation);
    const Vec step{d.normal(), 0.4f * d.normal(), d.normal()};
    const Vec place = stay ? eye : eye + normalized(step) * (max_translation * d.unit());
    set_pose(out, turn(right, axis, angle), turn(down, axis, angle), turn(forward, axis, angle),
             place);
    if (stay || in_free_space(room, out, 0.15f)) return out;
  }
  return out;
}

}  // namespace ps::rooms
