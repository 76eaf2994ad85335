// SPDX-License-Identifier: BSD-3-Clause
// A scene from its seed: its style, its rooms, what stands in them.
#include "libps/rooms/pieces.h"
#include "libps/rooms/set.h"

namespace ps::rooms {
namespace {

RoomKind pick_kind(Dice& d) {
  constexpr std::array<float, kRoomKinds> share = {0.12f, 0.17f, 0.14f, 0.2f,
                                                   0.07f, 0.13f, 0.11f, 0.06f};
  float left = d.unit();
  for (int k = 0; k < kRoomKinds; ++k) {
    left -= share[k];
    if (left < 0) return static_cast<RoomKind>(k);
  }
  return RoomKind::office;
}

Sky make_sky(Dice& d) {
  Sky s;
  s.seed = d.bits();
  const bool night = d.chance(0.08f);
  const float bright = night ? 0.01f : d.range(1.2f, 5);
  s.zenith = hsv(d.range(0.55f, 0.62f), d.range(0.1f, 0.55f), 0.85f) * bright;
  s.horizon = hsv(d.range(0.05f, 0.65f), d.range(0, 0.2f), 0.95f) * bright;
  s.ground = hsv(d.range(0.08f, 0.35f), d.range(0.05f, 0.4f), d.range(0.3f, 0.6f)) * bright;
  s.walls = hsv(d.range(0, 0.15f), d.range(0.05f, 0.4f), d.range(0.4f, 0.85f)) * bright * 0.8f;
  s.leaves =
      hsv(d.range(0.17f, 0.33f), d.range(0.2f, 0.5f), d.range(0.2f, 0.45f)) * (0.5f * bright);
  s.skyline = d.chance(0.3f) ? 0.02f : d.range(0.1f, 0.9f);
  const float azimuth = d.range(0, 6.2831853f), slope = d.range(0.25f, 1.1f);
  s.sun_direction = normalized({std::cos(azimuth), slope, std::sin(azimuth)});
  if (!night && d.chance(0.4f))
    s.sun_irradiance =
        Vec{1, d.range(0.8f, 0.95f), d.range(0.55f, 0.9f)} * bright * d.range(1.5f, 4);
  return s;
}

Style make_style(Set& set) {
  Dice& d = set.dice;
  Style s;
  s.wall = d.range(0.1f, 0.4f);
  const Vec light = hsv(d.range(0.05f, 0.2f), d.range(0, 0.08f), d.range(0.8f, 0.97f));
  const int wood = set.add(wood_material(d)),
            pale = set.add(plain(light, d.chance(0.4f) ? 0.03f : 0));
  const int colored = set.add(plain(any_color(d)));
  s.trim = d.pick({pale, pale, pale, wood, colored});
  s.door = d.pick({pale, pale, wood, colored, s.trim});
  s.frame = d.pick({pale, pale, pale, wood, colored});
  s.metal = set.add(metal(d));
  s.dark = set.add(plain(hsv(any_hue(d), d.range(0, 0.1f), d.range(0.05f, 0.2f)), 0.02f));
  s.white = set.add(plain(srgb(0.9f, 0.9f, 0.88f)));
  return s;
}

}  // namespace

void furnish(Scene& scene, std::uint64_t seed, const RoomOptions& options) {
  Set set{scene, Dice(seed, 1), options, {}, {}, {}};
  scene.mirrors = options.mirrors;
  scene.spaces.resize(1);
  scene.spaces[0].kind = pick_kind(set.dice);
  scene.sky = make_sky(set.dice);
  scene.key = set.dice.range(0.065f, 0.14f);
  scene.evening = set.dice.range(0.15f, 0.45f);
  set.style = make_style(set);
  std::vector<Plan> plans = plan_building(set);
  scene.spaces.clear();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    Space s;
    s.kind = plans[i].kind;
    s.rects = plans[i].rects;
    s.height = plans[i].height;
    s.low = {1e9f, 0, 1e9f};
    s.high = {-1e9f, s.height, -1e9f};
    for (const Rect& r : s.rects) {
      s.low = min(s.low, {r.x0, 0, r.z0});
      s.high = max(s.high, {r.x1, s.height, r.z1});
    }
    scene.spaces.push_back(s);
    build_walls(set, plans[i], i == 0);
  }
  for (std::size_t i = 0; i < plans.size(); ++i) {
    furnish_space(set, plans[i], i == 0);
    Dice d = set.dice.child();
    const float fill = d.range(0, 0.9f) * d.unit();
    const std::vector<Top> tops = std::move(set.tops);
    set.tops.clear();
    for (const Top& top : tops) strew(set, d, top, fill);
  }
}

}  // namespace ps::rooms
