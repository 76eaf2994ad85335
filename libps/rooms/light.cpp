// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/light.h"

#include <algorithm>
#include <cmath>

namespace ps::rooms {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kDirections = 3 * kRays;  ///< rays of a probe
constexpr int kBounces = 3;
const std::array<Four, 6> kDark = {};  ///< a probe's cube

/// What a probe's ray met.
struct Met {
  int probe;
  Vec direction, position, normal, albedo, direct;
};

Vec probe_place(const Probes& p, int index) {
  const int i = index % p.nx, j = index / p.nx % p.ny, k = index / (p.nx * p.ny);
  return p.low + p.step * Vec{static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)};
}

void lay_probes(Space& s) {
  Probes& p = s.probes;
  const Vec size = s.high - s.low;
  const auto count = [](float length, float pitch, int most) {
    return std::clamp(static_cast<int>(length / pitch) + 2, 2, most);
  };
  p.nx = count(size.x, 1.1f, 9);
  p.nz = count(size.z, 1.1f, 9);
  p.ny = count(size.y, 1.2f, 4);
  const Vec edge{0.12f, 0.12f, 0.12f};
  p.low = s.low + edge;
  const Vec inner = size - edge * 2;
  p.step = {inner.x / static_cast<float>(p.nx - 1), inner.y / static_cast<float>(p.ny - 1),
            inner.z / static_cast<float>(p.nz - 1)};
  p.cubes.assign(static_cast<std::size_t>(p.nx) * p.ny * p.nz, kDark);
}

/// Sixteen rays of a probe; @return how many saw the back of something.
int cast(const Scene& scene, const Space& space, Vec from, int probe, int packet,
         std::vector<Met>& met) {
  Rays rays;
  clear(rays);
  for (int i = 0; i < kRays; ++i) {
    const float k = static_cast<float>(packet * kRays + i);
    const float z = 1 - (2 * k + 1) / kDirections, r = std::sqrt(1 - z * z);
    const float a = 2.3999632f * k + static_cast<float>(probe % 7);
    set_ray(rays, i, from, {r * std::cos(a), z, r * std::sin(a)}, 100);
  }
  scene.nearest(rays);
  Lit lit[kRays];
  Surface surfaces[kRays];
  int behind = 0;
  for (int i = 0; i < kRays; ++i) {
    if (rays.face[i] < 0) continue;
    surfaces[i] = surface_of(scene, rays, i);
    behind += rays.reach[i] < 0.06f ? 1 : 0;
    lit[i].space = &space;
    lit[i].position = surfaces[i].position + surfaces[i].flat * 1e-3f;
    lit[i].normal = surfaces[i].flat;
    lit[i].choice = hash(probe, i, 1);
    lit[i].s = hash(probe, i, 2);
    lit[i].t = hash(probe, i, 3);
  }
  add_direct(scene, lit);
  for (int i = 0; i < kRays; ++i) {
    if (!lit[i].space) continue;
    const Surface& s = surfaces[i];
    const Vec d{rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]};
    met.push_back({probe, d, s.position, s.flat, albedo(*s.material, *s.pictures, s.u, s.v, 0.5f),
                   lit[i].irradiance});
  }
  return behind;
}

void bake_space(const Scene& scene, Space& space, std::vector<Vec>* seen,
                std::vector<Vec>* lights) {
  lay_probes(space);
  Probes& p = space.probes;
  const int count = static_cast<int>(p.cubes.size());
  std::vector<Met> met;
  met.reserve(static_cast<std::size_t>(count) * kDirections);
  std::vector<bool> inside(count);
  for (int probe = 0; probe < count; ++probe) {
    int behind = 0;
    const Vec from = probe_place(p, probe);
    for (int packet = 0; packet < kDirections / kRays; ++packet)
      behind += cast(scene, space, from, probe, packet, met);
    inside[probe] = behind > kDirections / 2;
  }
  for (int bounce = 0; bounce < kBounces; ++bounce) {
    Probes next = p;
    next.cubes.assign(count, kDark);
    for (const Met& m : met) {
      const Vec out = m.albedo * (m.direct + p.irradiance(m.position, m.normal)) * (1 / kPi);
      const float d[6] = {m.direction.x,  -m.direction.x, m.direction.y,
                          -m.direction.y, m.direction.z,  -m.direction.z};
      for (int f = 0; f < 6; ++f) {
        if (d[f] > 0) next.cubes[m.probe][f] += four(out) * (d[f] * 4 * kPi / kDirections);
      }
      if (seen && bounce == kBounces - 1) {
        seen->push_back(m.albedo);
        lights->push_back((m.direct + p.irradiance(m.position, m.normal)) * (1 / kPi));
      }
    }
    std::array<Four, 6> mean = kDark;
    int outside = 0;
    for (int i = 0; i < count; ++i) {
      if (inside[i]) continue;
      ++outside;
      for (int f = 0; f < 6; ++f) mean[f] += next.cubes[i][f];
    }
    for (Four& m : mean) m *= 1 / static_cast<float>(std::max(1, outside));
    for (int i = 0; i < count; ++i) {
      if (inside[i]) next.cubes[i] = mean;
    }
    p = std::move(next);
  }
}

}  // namespace

void bake(Scene& scene) {
  for (Space& space : scene.spaces) find_lights(scene, space);
  std::vector<Vec> seen, lights;
  for (std::size_t i = 0; i < scene.spaces.size(); ++i) {
    bake_space(scene, scene.spaces[i], i == 0 ? &seen : nullptr, i == 0 ? &lights : nullptr);
  }
  const auto middle = [](const std::vector<Vec>& v) {
    double sum = 0;
    for (const Vec& c : v) sum += std::log(std::max(luminance(c), 1e-4f));
    return v.empty() ? 1.f : std::exp(static_cast<float>(sum / static_cast<double>(v.size())));
  };
  scene.middle_light = middle(lights);
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = seen[i] * scene.evened(lights[i]);
  // As a photo: a white room may look bright, a dark one dark.
  const float mean = middle(seen);
  const float target = scene.key * std::pow(mean / scene.key / scene.middle_light, 0.35f);
  scene.exposure = target / std::max(mean, 1e-4f);
}

}  // namespace ps::rooms
