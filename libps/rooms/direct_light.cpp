// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "libps/rooms/isa.h"
#include "libps/rooms/light.h"

namespace ps::rooms {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kOwnRays = 2;       ///< groups of lights that are asked for certain
constexpr float kFaint = 0.003f;  ///< irradiance that nobody sees
constexpr int kMostRates = 192;   ///< emitters that are weighed for a packet

light_kernel::Places places_of(const Lit* lit) {
  light_kernel::Places p;
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
  const LightGroup* group;
  const float (*rates)[kRays];  ///< of each emitter at each place
  float all[kRays];             ///< rates of all emitters at each place
  float total[kRays];           ///< brightness of all; 0 where they do not shine
  float sum;
};

/// A sample of the group at place i; `choice` in [0, 1) picks the emitter.
Sample sample(const Weighed& w, const Lit& l, int i, float choice, float probability) {
  const int count = static_cast<int>(w.group->emitters.size());
  const float all = w.all[i];
  float left = choice * all;
  int pick = 0;
  while (pick + 1 < count && left >= w.rates[pick][i]) left -= w.rates[pick++][i];
  if (!(w.rates[pick][i] > 0)) return {};
  return sample(*w.group, w.group->emitters[pick], l, probability * w.rates[pick][i] / all);
}

/// Weighs a group; `lit` are the groups that shine at each place.
/// @return false when it brings nothing to any place
bool weigh(const LightGroup& group, std::uint32_t bit, const std::uint32_t* lit,
           const light_kernel::Places& places, float (*rates)[kRays], Weighed& w) {
  w.group = &group;
  w.rates = rates;
  w.sum = 0;
  PS_FITTING(light_kernel::weigh)
  (group.lamps.data(), static_cast<int>(group.lamps.size()), places, luminance(group.radiance),
   rates, w.all, w.total);
  for (int i = 0; i < kRays; ++i) {
    if (w.total[i] < kFaint || (lit[i] & bit) == 0) w.total[i] = 0;
    w.sum += w.total[i];
  }
  return w.sum > 0;
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
  std::uint32_t lit_by[kRays], any_lit = 0;
  for (int i = 0; i < kRays; ++i) any_lit |= lit_by[i] = lit[i].space ? lit[i].space->lit_by : 0;
  const light_kernel::Places places = places_of(lit);
  float rates[kMostRates][kRays];
  Weighed weighed[kMostLights];
  Weighed* sorted[kMostLights];
  int used = 0, count = 0;
  for (std::size_t g = 0; g < scene.lights.size(); ++g) {
    const std::uint32_t bit = std::uint32_t{1} << g;
    const int emitters = static_cast<int>(scene.lights[g].emitters.size());
    if ((any_lit & bit) == 0 || used + emitters > kMostRates) continue;
    if (!weigh(scene.lights[g], bit, lit_by, places, rates + used, weighed[count])) continue;
    sorted[count] = &weighed[count];
    used += emitters;
    ++count;
  }
  std::sort(sorted, sorted + count,
            [](const Weighed* a, const Weighed* b) { return a->sum > b->sum; });
  // The strongest have rays of their own; of the others each place asks one.
  const int own = count <= kOwnRays + 1 ? count : kOwnRays;
  for (int g = 0; g < own; ++g) {
    Sample samples[kRays];
    for (int i = 0; i < kRays; ++i) {
      if (sorted[g]->total[i] > 0) samples[i] = sample(*sorted[g], lit[i], i, lit[i].choice, 1);
    }
    add_samples(scene, lit, samples);
  }
  if (own < count) {
    Sample samples[kRays];
    for (int i = 0; i < kRays; ++i) {
      float all = 0;
      for (int g = own; g < count; ++g) all += sorted[g]->total[i];
      if (all <= 0) continue;
      float left = lit[i].choice * all;
      int pick = own;
      while (pick + 1 < count && left >= sorted[pick]->total[i]) left -= sorted[pick++]->total[i];
      const float here = sorted[pick]->total[i];
      if (here <= 0) continue;
      samples[i] = sample(*sorted[pick], lit[i], i, std::min(left / here, 0.999f), here / all);
    }
    add_samples(scene, lit, samples);
  }
  if (luminance(scene.sky.sun_irradiance) > 0) add_sun(scene, lit);
}

void find_lights(const Scene& scene, Space& space) {
  constexpr int kPackets = 24;
  space.lit_by = 0;
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
      const std::uint32_t bit = std::uint32_t{1} << g;
      if ((space.lit_by & bit) != 0) continue;
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
        if (luminance(l.irradiance) > kFaint) space.lit_by |= bit;
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
