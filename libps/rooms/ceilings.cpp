// SPDX-License-Identifier: BSD-3-Clause
// Lamps, beams and ducts.
#include <algorithm>

#include "libps/rooms/shell.h"

namespace ps::rooms {
namespace {

/// One kind of ceiling lamp at (x, z); adds what it emits.
struct CeilingLamp {
  int kind = 0;
  float size = 0.5f, drop = 0;
  bool along_z = false;
  int glow = 0, body = 0;
};

void build_ceiling_lamp(Set& set, const CeilingLamp& l, float x, float y, float z, LightGroup& g) {
  Builder b = set.solid(Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {x, y, z}});
  Builder glow = set.lamps(b.frame());
  const float s = l.size;
  if (l.kind == 0) {  // panel in the ceiling
    glow.box({-s, -0.015f, -s}, {s, 0.01f, s}, l.glow);
    g.add({{x, y - 0.02f, z}, {s, 0, 0}, {0, 0, s}, {0, -1, 0}});
  } else if (l.kind == 1) {  // tube
    const float hx = l.along_z ? 0.06f : 0.65f, hz = l.along_z ? 0.65f : 0.06f;
    b.box({-hx - 0.02f, -l.drop, -hz - 0.02f}, {hx + 0.02f, -l.drop + 0.05f, hz + 0.02f}, l.body);
    glow.box({-hx, -l.drop - 0.03f, -hz}, {hx, -l.drop, hz}, l.glow);
    g.add({{x, y - l.drop - 0.04f, z}, {hx, 0, 0}, {0, 0, hz}, {0, -1, 0}});
  } else if (l.kind == 2) {  // pendant
    b.rod({0, -l.drop, 0}, {0, 0, 0}, 0.005f, l.body, 5);
    glow.lathe({0, -l.drop - 0.2f, 0}, {{s * 0.5f, 0}, {s * 0.35f, 0.15f}, {0.05f, 0.2f}}, l.glow,
               16);
    g.add({{x, y - l.drop - 0.12f, z}, {0.1f, 0, 0}, {}, {}, true});
  } else if (l.kind == 3) {  // spot
    b.cylinder({0, -0.05f - l.drop, 0}, 0.05f, 0.05f + l.drop, l.body, 0.05f, 10);
    glow.cylinder({0, -0.056f - l.drop, 0}, 0.04f, 0.004f, l.glow, -1, 10);
    g.add({{x, y - 0.07f - l.drop, z}, {0.06f, 0, 0}, {0, 0, 0.06f}, {0, -1, 0}});
  } else {  // dome
    glow.lathe({0, -0.12f, 0}, {{0, 0}, {s * 0.3f, 0.02f}, {s * 0.5f, 0.07f}, {s * 0.55f, 0.12f}},
               l.glow, 16);
    g.add({{x, y - 0.15f, z}, {s * 0.4f, 0, 0}, {0, 0, s * 0.4f}, {0, -1, 0}});
  }
}

Vec lamp_color(Dice& d) {
  const float warm = d.unit();
  // What a camera's white balance leaves of it.
  return {1, mix(0.97f, 0.8f, warm), mix(0.95f, 0.55f, warm)};
}

}  // namespace

void light_ceiling(Set& set, Dice& d, const Plan& plan, bool on) {
  const Rect& r = plan.rects[0];
  LightGroup g;
  CeilingLamp l;
  const bool working = plan.kind == RoomKind::office || plan.kind == RoomKind::corridor ||
                       plan.kind == RoomKind::storage || plan.kind == RoomKind::hall;
  l.kind = working ? d.pick({0, 1, 3, 0, 1, 4, 2}) : d.pick({2, 3, 4, 2, 4, 0});
  l.size = l.kind == 0 ? d.range(0.15f, 0.31f) : d.range(0.25f, 0.6f);
  l.drop = l.kind == 2      ? d.range(0.2f, std::max(0.25f, plan.height - 1.95f))
           : d.chance(0.5f) ? 0
                            : d.range(0, plan.height > 2.7f ? 0.6f : 0.15f);
  l.along_z = d.chance(0.5f);
  const Vec tint = lamp_color(d);
  g.radiance = tint;
  Material glow = plain(srgb(0.9f, 0.9f, 0.85f));
  if (on) glow.emission = tint * 3;
  l.glow = set.add(glow);
  l.body = d.chance(0.5f) ? set.style.white : set.style.dark;
  const float pitch = l.kind == 3 ? d.range(0.9f, 1.8f) : d.range(1.8f, 3.5f);
  const bool single = l.kind == 2 || (l.kind == 4 && !working);
  const int nx = single ? 1 : std::clamp(static_cast<int>(r.width() / pitch), 1, 4);
  const int nz = single ? 1 : std::clamp(static_cast<int>(r.depth() / pitch), 1, 6);
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < nz; ++j) {
      build_ceiling_lamp(
          set, l, mix(r.x0, r.x1, (static_cast<float>(i) + 0.5f) / static_cast<float>(nx)),
          plan.height, mix(r.z0, r.z1, (static_cast<float>(j) + 0.5f) / static_cast<float>(nz)), g);
    }
  }
  if (!on) return;
  // About the same light for each square metre of floor, whatever the lamps.
  const float strength = d.range(0.5f, 1.6f) * r.width() * r.depth() * 0.35f / g.area;
  g.radiance = g.radiance * strength;
  set.add(g);
}

void build_beams(Set& set, Dice& d, const Plan& plan) {
  const Rect& r = plan.rects[0];
  const int m = d.chance(0.5f) ? set.add(wood_material(d)) : plan.ceiling;
  const float deep = d.range(0.08f, 0.25f), wide = d.range(0.08f, 0.25f), pitch = d.range(0.7f, 2);
  for (float z = r.z0 + pitch / 2; z < r.z1; z += pitch) {
    set.solid().box({r.x0, plan.height - deep, z - wide / 2}, {r.x1, plan.height, z + wide / 2}, m,
                    0.01f);
  }
}

void build_ducts(Set& set, Dice& d, const Plan& plan) {
  const Rect& r = plan.rects[0];
  const int m = d.chance(0.5f) ? set.style.metal : d.chance(0.5f) ? set.style.dark : plan.ceiling;
  const int count = d.whole(1, 3), kind = d.below(3);
  for (int i = 0; i < count; ++i) {
    const bool along_x = d.chance(0.3f);
    const float across =
        along_x ? d.range(r.z0 + 0.2f, r.z1 - 0.2f) : d.range(r.x0 + 0.2f, r.x1 - 0.2f);
    const float size = kind == 0 ? d.range(0.02f, 0.06f) : d.range(0.1f, 0.2f);
    const float y = plan.height - size - d.range(0, 0.15f);
    const Vec from = along_x ? Vec{r.x0, y, across} : Vec{across, y, r.z0};
    const Vec to = along_x ? Vec{r.x1, y, across} : Vec{across, y, r.z1};
    if (kind < 2) {
      set.solid().rod(from, to, size, m, 12);
    } else {
      const Vec half = along_x ? Vec{0, size * 0.6f, size} : Vec{size, size * 0.6f, 0};
      set.solid().box(from - half, to + half, m);
    }
  }
}

}  // namespace ps::rooms
