// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/scene.h"

#include <limits>

namespace ps::rooms {
namespace {

/// World to part: axes are at right angles.
trace_kernel::Axes axes_of(const Frame& f) {
  return {{{f.ex.x, f.ex.y, f.ex.z}, {f.ey.x, f.ey.y, f.ey.z}, {f.ez.x, f.ez.y, f.ez.z}},
          {dot(f.ex, f.ex), dot(f.ey, f.ey), dot(f.ez, f.ez)},
          {f.origin.x, f.origin.y, f.origin.z}};
}

constexpr int kOwnParts = 2;  ///< the scene's meshes, before the placed models

}  // namespace

void Scene::nearest(Rays& rays) const {
  for (int p = 0; p < kOwnParts; ++p) rooms::nearest(*parts[p].tree, p, rays);
  std::uint32_t models[kMostParts];
  const int count = reached(part_tree, rays, models);
  for (int m = 0; m < count; ++m) {
    const int p = kOwnParts + static_cast<int>(models[m]);
    Rays local;
    enter(axes_of(parts[p].world), rays, local);
    rooms::nearest(*parts[p].tree, p, local);
    for (int i = 0; i < kRays; ++i) {
      const bool hit = local.face[i] >= 0;
      rays.reach[i] = hit ? local.reach[i] : rays.reach[i];
      rays.u[i] = hit ? local.u[i] : rays.u[i];
      rays.v[i] = hit ? local.v[i] : rays.v[i];
      rays.face[i] = hit ? local.face[i] : rays.face[i];
      rays.part[i] = hit ? p : rays.part[i];
    }
  }
}

void Scene::blocked(Rays& rays) const {
  for (int p = 0; p < kOwnParts; ++p) {
    if (parts[p].casts) rooms::blocked(*parts[p].tree, rays);
  }
  std::uint32_t models[kMostParts];
  const int count = reached(part_tree, rays, models);
  for (int m = 0; m < count; ++m) {
    const Part& part = parts[kOwnParts + models[m]];
    Rays local;
    enter(axes_of(part.world), rays, local);
    rooms::blocked(*part.tree, local);
    for (int i = 0; i < kRays; ++i) rays.reach[i] = local.reach[i] < 0 ? -1.f : rays.reach[i];
  }
}

void LightGroup::add(Emitter e) {
  if (emitters.size() >= kMostEmitters) return;
  e.area = e.round ? 3.14159f * e.half_u.x * e.half_u.x : 4 * length(e.half_u) * length(e.half_v);
  e.radius = std::sqrt(dot(e.half_u, e.half_u) + dot(e.half_v, e.half_v));
  const auto count = static_cast<float>(emitters.size());
  middle = (middle * count + e.center) * (1 / (count + 1));
  emitters.push_back(e);
  lamps.push_back({{e.center.x, e.center.y, e.center.z},
                   {e.normal.x, e.normal.y, e.normal.z},
                   e.area,
                   e.radius,
                   e.round ? 1.f : 0.f});
  area += e.area;
}

Vec Scene::evened(Vec light) const {
  light += Vec{1, 1, 1} * (0.04f * middle_light);  // no place is quite dark
  return light * std::pow(luminance(light) / middle_light, -evening);
}

bool Scene::inside_thing(Vec p) const {
  for (const auto& t : things) {
    if (p.x > t[0].x && p.y > t[0].y && p.z > t[0].z && p.x < t[1].x && p.y < t[1].y &&
        p.z < t[1].z) {
      return true;
    }
  }
  return false;
}

const Space& Scene::space_at(Vec p) const {
  const Space* best = &spaces[0];
  float least = std::numeric_limits<float>::max();
  for (const Space& s : spaces) {
    const Vec out = max(max(s.low - p, p - s.high), Vec{});
    const float d = dot(out, out);
    if (d < least) {
      least = d;
      best = &s;
    }
  }
  return *best;
}

bool Space::holds(Vec p, float grow) const {
  if (p.y < -grow || p.y > height + grow) return false;
  for (const Rect& r : rects) {
    if (r.grown(grow).holds(p.x, p.z)) return true;
  }
  return false;
}

Surface surface_of(const Scene& scene, const Rays& rays, int i) {
  const Part& part = scene.parts[rays.part[i]];
  const Face& face = part.mesh->faces[rays.face[i]];
  const Corner& a = part.mesh->corners[face.corners[0]];
  const Corner& b = part.mesh->corners[face.corners[1]];
  const Corner& c = part.mesh->corners[face.corners[2]];
  const float u = rays.u[i], v = rays.v[i], w = 1 - u - v;
  const Vec direction{rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]};
  Surface s;
  s.position =
      Vec{rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]} + direction * rays.reach[i];
  Vec e1 = b.position - a.position, e2 = c.position - a.position;
  Vec n = a.normal * w + b.normal * u + c.normal * v;
  if (part.placed) {
    e1 = part.world.direction(e1);
    e2 = part.world.direction(e2);
    // Normals go with the inverse of the scales.
    const Frame& f = part.world;
    n = f.ex * (n.x / dot(f.ex, f.ex)) + f.ey * (n.y / dot(f.ey, f.ey)) +
        f.ez * (n.z / dot(f.ez, f.ez));
  }
  const Vec g = cross(e1, e2);
  s.from_behind = dot(g, direction) > 0;
  s.flat = normalized(s.from_behind ? -g : g);
  s.normal = normalized(n);
  if (dot(s.normal, s.flat) < 0) s.normal = -s.normal;
  s.u = a.u * w + b.u * u + c.u * v;
  s.v = a.v * w + b.v * u + c.v * v;
  s.material = &(*part.materials)[face.material];
  s.pictures = part.pictures;
  if (s.material->pattern == Pattern::picture || s.material->pattern == Pattern::text) {
    const float area = std::abs((b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v));
    s.uv_per_metre = std::sqrt(area / std::max(length(g), 1e-12f));
  }
  return s;
}

Vec Sky::radiance(Vec d) const {
  d = normalized(d);
  const float azimuth = std::atan2(d.x, d.z) * 6;
  const float flat = std::sqrt(d.x * d.x + d.z * d.z) + 1e-6f;
  const float slope = d.y / flat;
  const int house = static_cast<int>(std::floor(azimuth * 0.8f));
  const float roof = skyline * (0.4f + hash(house, 1, seed));
  const float crown = skyline * 1.2f * (noise(azimuth * 1.7f, 0, seed + 3) - 0.35f) +
                      0.05f * noise(azimuth * 14, slope * 30, seed + 4);
  if (slope < -0.06f) return ground * (0.7f + 0.6f * noise(d.x / -d.y, d.z / -d.y, seed));
  if (slope < crown) return leaves * (0.4f + 1.2f * noise(azimuth * 25, slope * 80, seed + 5));
  if (slope < roof) {
    const float x = azimuth * 4 + hash(house, 2, seed), y = slope * 22;
    const bool pane = x - std::floor(x) > 0.45f && y - std::floor(y) > 0.45f;
    return walls * ((0.6f + 0.8f * hash(house, 3, seed)) * (pane ? 0.35f : 1.f));
  }
  const float cloud = smooth_step(0.5f, 0.8f, noise(azimuth, slope * 5, seed + 6));
  return mix(mix(horizon, zenith, clamp01(slope)), horizon, 0.5f * cloud);
}

Vec Probes::irradiance(Vec p, Vec n) const {
  const auto axis = [](float x, float start, float size, int count, int& i) {
    const float t = std::clamp((x - start) / size, 0.f, static_cast<float>(count) - 1.001f);
    i = static_cast<int>(t);
    return t - static_cast<float>(i);
  };
  int i, j, k;
  const float a = axis(p.x, low.x, step.x, nx, i), b = axis(p.y, low.y, step.y, ny, j),
              c = axis(p.z, low.z, step.z, nz, k);
  const float nn[3] = {n.x * n.x, n.y * n.y, n.z * n.z};
  const int face[3] = {n.x > 0 ? 0 : 1, n.y > 0 ? 2 : 3, n.z > 0 ? 4 : 5};
  Four sum = four(0);
  for (int corner = 0; corner < 8; ++corner) {
    const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
    const float w = (di ? a : 1 - a) * (dj ? b : 1 - b) * (dk ? c : 1 - c);
    const auto& cube = cubes[(static_cast<std::size_t>(k + dk) * ny + j + dj) * nx + i + di];
    sum += (cube[face[0]] * nn[0] + cube[face[1]] * nn[1] + cube[face[2]] * nn[2]) * w;
  }
  return vec(sum);
}

}  // namespace ps::rooms
