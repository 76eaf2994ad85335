// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/light.h"

#include <algorithm>
#include <cmath>

namespace ps::rooms {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kDirections = 3 * kRays;  ///< rays of a probe
constexpr int kBounces = 3;
constexpr std::size_t kOwnRays = 2;  ///< groups of lights that are asked for certain
constexpr float kFaint = 0.003f;     ///< irradiance that nobody sees

/// About what an emitter would send if nothing stood between.
float rate(const Emitter& e, Vec p, Vec n) {
  const Vec to = e.center - p;
  const float d2 = std::max(dot(to, to), 0.01f);
  const float at_surface = std::max(0.f, dot(n, to) + 0.3f * e.radius);
  // A ball shines the same way all around.
  const float at_lamp = e.round ? std::sqrt(d2) : std::max(0.f, -dot(e.normal, to));
  return e.area * at_surface * at_lamp / (d2 * (d2 + e.radius * e.radius));
}

/// Where a shadow ray goes, and what comes from there if nothing stands between.
struct Sample {
  Vec to;
  Vec irradiance;
};

/// What the emitters of a group would send to a place, one by one.
struct Rates {
  float of[kMostEmitters];
  float total = 0;
};

Rates rates_of(const LightGroup& g, const Lit& l) {
  Rates r;
  const int n = static_cast<int>(g.emitters.size());
  for (int i = 0; i < n; ++i) r.total += r.of[i] = rate(g.emitters[i], l.position, l.normal);
  return r;
}

/// A random point of the group. `choice` in [0,1) picks the emitter.
Sample sample_group(const LightGroup& g, const Lit& l, float choice) {
  const Rates rates = rates_of(g, l);
  const int used = static_cast<int>(g.emitters.size());
  float left = choice * rates.total;
  int pick = 0;
  while (pick + 1 < used && left >= rates.of[pick]) left -= rates.of[pick++];
  const Emitter& e = g.emitters[pick];
  const float share = rates.of[pick] / rates.total;
  if (!(share > 0)) return {};
  Vec to;
  float area;
  if (e.round) {
    const float z = 2 * l.s - 1, r = std::sqrt(std::max(0.f, 1 - z * z)), a = 2 * kPi * l.t;
    to = e.center + Vec{r * std::cos(a), z, r * std::sin(a)} * e.half_u.x - l.position;
    area = kPi * e.half_u.x * e.half_u.x;
  } else {
    to = e.center + e.half_u * (2 * l.s - 1) + e.half_v * (2 * l.t - 1) - l.position;
    area = 4 * length(e.half_u) * length(e.half_v);
  }
  const float d2 = std::max(dot(to, to), 0.0025f), d = std::sqrt(d2);
  const float at_surface = dot(l.normal, to) / d;
  const float at_lamp = e.round ? 1.f : -dot(e.normal, to) / d;
  if (at_surface <= 0 || at_lamp <= 0) return {};
  return {to, g.radiance * std::min(area * at_surface * at_lamp / (d2 * share), kPi)};
}

/// One shadow ray for each place that has a sample.
void add_samples(const Scene& scene, Lit* lit, const Sample* samples) {
  Rays rays;
  clear(rays);
  bool any = false;
  for (int i = 0; i < kRays; ++i) {
    if (!lit[i].space || luminance(samples[i].irradiance) <= 0) continue;
    set_ray(rays, i, lit[i].position, samples[i].to, 0.97f);
    any = true;
  }
  if (!any) return;
  scene.blocked(rays);
  for (int i = 0; i < kRays; ++i) {
    if (rays.reach[i] > 0) lit[i].irradiance += samples[i].irradiance;
  }
}

void add_sun(const Scene& scene, Lit* lit) {
  Rays rays;
  clear(rays);
  bool any = false;
  const Vec sun = scene.sky.sun_direction;
  for (int i = 0; i < kRays; ++i) {
    if (!lit[i].space || !lit[i].space->sunny || dot(lit[i].normal, sun) <= 0) continue;
    any = true;
    const Vec spread{(lit[i].s - 0.5f) * 0.02f, 0, (lit[i].t - 0.5f) * 0.02f};
    set_ray(rays, i, lit[i].position, sun + spread, 100);
  }
  if (!any) return;
  scene.blocked(rays);
  for (int i = 0; i < kRays; ++i) {
    if (rays.reach[i] > 0) {
      lit[i].irradiance += scene.sky.sun_irradiance * dot(lit[i].normal, sun);
    }
  }
}

}  // namespace

void add_direct(const Scene& scene, Lit* lit) {
  // How much each group would give, for each place and in all.
  struct Group {
    int index = 0;
    float sum = 0;
    float to[kRays];
  };
  Group groups[kMostLights];
  std::size_t count = 0;
  for (std::size_t g = 0; g < scene.lights.size(); ++g) {
    Group& group = groups[count];
    group.index = static_cast<int>(g);
    group.sum = 0;
    for (int i = 0; i < kRays; ++i) {
      group.to[i] = 0;
      if (!lit[i].space || !lit[i].space->lit_by[g]) continue;
      const float r = rates_of(scene.lights[g], lit[i]).total * luminance(scene.lights[g].radiance);
      if (r > kFaint) group.sum += group.to[i] = r;
    }
    if (group.sum > 0) ++count;
  }
  std::sort(groups, groups + count, [](const Group& a, const Group& b) { return a.sum > b.sum; });
  // The strongest have rays of their own; of the others each place asks one.
  const std::size_t own = count <= kOwnRays + 1 ? count : kOwnRays;
  for (std::size_t g = 0; g < own; ++g) {
    Sample samples[kRays];
    for (int i = 0; i < kRays; ++i) {
      if (groups[g].to[i] > 0) {
        samples[i] = sample_group(scene.lights[groups[g].index], lit[i], lit[i].choice);
      }
    }
    add_samples(scene, lit, samples);
  }
  if (own < count) {
    Sample samples[kRays];
    for (int i = 0; i < kRays; ++i) {
      float total = 0;
      for (std::size_t g = own; g < count; ++g) total += groups[g].to[i];
      if (total <= 0) continue;
      float left = lit[i].choice * total;
      std::size_t pick = own;
      while (pick + 1 < count && left >= groups[pick].to[i]) left -= groups[pick++].to[i];
      const float share = groups[pick].to[i] / total;
      if (share <= 0) continue;
      samples[i] = sample_group(scene.lights[groups[pick].index], lit[i],
                                std::min(left / groups[pick].to[i], 0.999f));
      samples[i].irradiance *= 1 / share;
    }
    add_samples(scene, lit, samples);
  }
  if (luminance(scene.sky.sun_irradiance) > 0) add_sun(scene, lit);
}

namespace {

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
  p.cubes.assign(static_cast<std::size_t>(p.nx) * p.ny * p.nz, {});
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
    next.cubes.assign(count, {});
    for (const Met& m : met) {
      const Vec out = m.albedo * (m.direct + p.irradiance(m.position, m.normal)) * (1 / kPi);
      const float d[6] = {m.direction.x,  -m.direction.x, m.direction.y,
                          -m.direction.y, m.direction.z,  -m.direction.z};
      for (int f = 0; f < 6; ++f) {
        if (d[f] > 0) next.cubes[m.probe][f] += out * (d[f] * 4 * kPi / kDirections);
      }
      if (seen && bounce == kBounces - 1) {
        seen->push_back(m.albedo);
        lights->push_back((m.direct + p.irradiance(m.position, m.normal)) * (1 / kPi));
      }
    }
    std::array<Vec, 6> mean{};
    int outside = 0;
    for (int i = 0; i < count; ++i) {
      if (inside[i]) continue;
      ++outside;
      for (int f = 0; f < 6; ++f) mean[f] += next.cubes[i][f];
    }
    for (Vec& m : mean) m *= 1 / static_cast<float>(std::max(1, outside));
    for (int i = 0; i < count; ++i) {
      if (inside[i]) next.cubes[i] = mean;
    }
    p = std::move(next);
  }
}

/// Finds which lights reach a space at all, by random rays.
void find_lights(const Scene& scene, Space& space) {
  space.lit_by.assign(scene.lights.size(), false);
  space.sunny = false;
  const Vec size = space.high - space.low;
  for (int packet = 0; packet < 24; ++packet) {
    Lit lit[kRays];
    for (int i = 0; i < kRays; ++i) {
      const int k = packet * kRays + i;
      lit[i].space = &space;
      lit[i].position = space.low + size * Vec{hash(k, 1, 7), hash(k, 2, 7), hash(k, 3, 7)};
      lit[i].s = hash(k, 4, 7);
      lit[i].t = hash(k, 5, 7);
    }
    for (std::size_t g = 0; g < scene.lights.size(); ++g) {
      if (space.lit_by[g]) continue;
      Sample samples[kRays];
      for (int i = 0; i < kRays; ++i) {
        lit[i].normal = normalized(scene.lights[g].middle - lit[i].position);
        lit[i].irradiance = {};
        samples[i] = sample_group(scene.lights[g], lit[i], lit[i].s);
      }
      add_samples(scene, lit, samples);
      for (const Lit& l : lit) {
        if (luminance(l.irradiance) > kFaint) space.lit_by[g] = true;
      }
    }
    if (space.sunny || luminance(scene.sky.sun_irradiance) <= 0) continue;
    space.sunny = true;  // so that the sun is asked
    for (Lit& l : lit) {
      l.normal = scene.sky.sun_direction;
      l.irradiance = {};
    }
    add_sun(scene, lit);
    space.sunny = false;
    for (const Lit& l : lit) space.sunny |= luminance(l.irradiance) > 0;
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
