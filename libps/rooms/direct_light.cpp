// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "libps/rooms/light.h"

namespace ps::rooms {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kOwnRays = 2;       ///< groups of lights that are asked for certain
constexpr float kFaint = 0.003f;  ///< irradiance that nobody sees
constexpr int kMostRates = 192;   ///< emitters that are weighed for a packet

/// The places of a packet, side by side for the compiler to turn into vectors.
struct Places {
  float x[kRays], y[kRays], z[kRays], nx[kRays], ny[kRays], nz[kRays];
};

Places places_of(const Lit* lit) {
  Places p;
  for (int i = 0; i < kRays; ++i) {
    p.x[i] = lit[i].position.x;
    p.y[i] = lit[i].position.y;
    p.z[i] = lit[i].position.z;
    p.nx[i] = lit[i].normal.x;
    p.ny[i] = lit[i].normal.y;
    p.nz[i] = lit[i].normal.z;
  }
  return p;
}

/// About what an emitter would send to each place if nothing stood between.
void weigh(const Emitter& e, const Places& p, float* out) {
  const float size = e.radius * e.radius, over = 0.3f * e.radius, round = e.round ? 1.f : 0.f;
  for (int i = 0; i < kRays; ++i) {
    const float x = e.center.x - p.x[i], y = e.center.y - p.y[i], z = e.center.z - p.z[i];
    const float square = x * x + y * y + z * z, d2 = square > 0.01f ? square : 0.01f;
    const float s = p.nx[i] * x + p.ny[i] * y + p.nz[i] * z + over;
    const float flat = -(e.normal.x * x + e.normal.y * y + e.normal.z * z);
    // A ball shines the same way all around.
    const float l = round * std::sqrt(d2) + (1 - round) * flat;
    out[i] = e.area * (s > 0 ? s : 0.f) * (l > 0 ? l : 0.f) / (d2 * (d2 + size));
  }
}

/// Where a shadow ray goes, and what comes from there if nothing stands between.
struct Sample {
  Vec to;
  Vec irradiance;
};

/// A random point of an emitter that is chosen with this probability.
Sample sample(const LightGroup& g, const Emitter& e, const Lit& l, float probability) {
  Vec to = e.center - l.position;
  if (e.round) {
    const float z = 2 * l.s - 1, r = std::sqrt(std::max(0.f, 1 - z * z)), a = 2 * kPi * l.t;
    to += Vec{r * std::cos(a), z, r * std::sin(a)} * e.half_u.x;
  } else {
    to += e.half_u * (2 * l.s - 1) + e.half_v * (2 * l.t - 1);
  }
  const float d2 = std::max(dot(to, to), 0.0025f), d = std::sqrt(d2);
  const float at_surface = dot(l.normal, to) / d;
  const float at_lamp = e.round ? 1.f : -dot(e.normal, to) / d;
  if (at_surface <= 0 || at_lamp <= 0) return {};
  const float form = std::min(e.area * at_surface * at_lamp / d2, kPi);
  return {to, g.radiance * (form / std::max(probability, 0.02f))};
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

/// A group of lights as a packet sees it.
struct Weighed {
  const LightGroup* group = nullptr;
  const float (*rates)[kRays] = nullptr;  ///< of each emitter at each place
  float total[kRays] = {};                ///< brightness of all at each place
  float sum = 0;
};

/// A sample of the group at place i; `choice` in [0, 1) picks the emitter.
Sample sample(const Weighed& w, const Lit& l, int i, float choice, float probability) {
  const int count = static_cast<int>(w.group->emitters.size());
  float all = 0;
  for (int e = 0; e < count; ++e) all += w.rates[e][i];
  float left = choice * all;
  int pick = 0;
  while (pick + 1 < count && left >= w.rates[pick][i]) left -= w.rates[pick++][i];
  if (!(w.rates[pick][i] > 0)) return {};
  return sample(*w.group, w.group->emitters[pick], l, probability * w.rates[pick][i] / all);
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
  const Places places = places_of(lit);
  float rates[kMostRates][kRays];
  Weighed weighed[kMostLights];
  int used = 0, count = 0;
  for (std::size_t g = 0; g < scene.lights.size(); ++g) {
    const LightGroup& group = scene.lights[g];
    const int emitters = static_cast<int>(group.emitters.size());
    bool lights = false;
    for (int i = 0; i < kRays; ++i) lights |= lit[i].space && lit[i].space->lit_by[g];
    if (!lights || used + emitters > kMostRates) continue;
    Weighed& w = weighed[count] = {&group, rates + used};
    for (int e = 0; e < emitters; ++e) weigh(group.emitters[e], places, rates[used + e]);
    const float bright = luminance(group.radiance);
    for (int i = 0; i < kRays; ++i) {
      if (!lit[i].space || !lit[i].space->lit_by[g]) continue;
      for (int e = 0; e < emitters; ++e) w.total[i] += rates[used + e][i] * bright;
      if (w.total[i] < kFaint) w.total[i] = 0;
      w.sum += w.total[i];
    }
    if (w.sum <= 0) continue;
    used += emitters;
    ++count;
  }
  std::sort(weighed, weighed + count,
            [](const Weighed& a, const Weighed& b) { return a.sum > b.sum; });
  // The strongest have rays of their own; of the others each place asks one.
  const int own = count <= kOwnRays + 1 ? count : kOwnRays;
  for (int g = 0; g < own; ++g) {
    Sample samples[kRays];
    for (int i = 0; i < kRays; ++i) {
      if (weighed[g].total[i] > 0) samples[i] = sample(weighed[g], lit[i], i, lit[i].choice, 1);
    }
    add_samples(scene, lit, samples);
  }
  if (own < count) {
    Sample samples[kRays];
    for (int i = 0; i < kRays; ++i) {
      float all = 0;
      for (int g = own; g < count; ++g) all += weighed[g].total[i];
      if (all <= 0) continue;
      float left = lit[i].choice * all;
      int pick = own;
      while (pick + 1 < count && left >= weighed[pick].total[i]) left -= weighed[pick++].total[i];
      const float here = weighed[pick].total[i];
      if (here <= 0) continue;
      samples[i] = sample(weighed[pick], lit[i], i, std::min(left / here, 0.999f), here / all);
    }
    add_samples(scene, lit, samples);
  }
  if (luminance(scene.sky.sun_irradiance) > 0) add_sun(scene, lit);
}

void find_lights(const Scene& scene, Space& space) {
  constexpr int kPackets = 24;
  space.lit_by.assign(scene.lights.size(), false);
  space.sunny = luminance(scene.sky.sun_irradiance) > 0;
  bool sunny = false;
  const Vec size = space.high - space.low;
  for (int packet = 0; packet < kPackets; ++packet) {
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
      const LightGroup& group = scene.lights[g];
      Sample samples[kRays];
      for (int i = 0; i < kRays; ++i) {
        const Emitter& e = group.emitters[(packet * kRays + i) % group.emitters.size()];
        lit[i].normal = normalized(e.center - lit[i].position);
        lit[i].irradiance = {};
        samples[i] = sample(group, e, lit[i], 1);
      }
      add_samples(scene, lit, samples);
      for (const Lit& l : lit) {
        if (luminance(l.irradiance) > kFaint) space.lit_by[g] = true;
      }
    }
    if (!space.sunny || sunny) continue;
    for (Lit& l : lit) {
      l.normal = scene.sky.sun_direction;
      l.irradiance = {};
    }
    add_sun(scene, lit);
    for (const Lit& l : lit) sunny |= luminance(l.irradiance) > 0;
  }
  space.sunny = sunny;
}

}  // namespace ps::rooms
