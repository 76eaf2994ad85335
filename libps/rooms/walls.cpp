// SPDX-License-Identifier: BSD-3-Clause
// Floors, walls, ceilings, doors, windows and what belongs to them.
#include <algorithm>

#include "libps/rooms/set.h"

namespace ps::rooms {
namespace {

struct Trim {
  float skirting = 0, cornice = 0;
  float dado = 0;  ///< height up to which walls are of another colour
  int dado_material = 0;
};

/// A piece of wall in its two colours.
void wall_panel(Builder& b, const Edge& e, const Trim& trim, float x0, float y0, float x1,
                float y1) {
  const float y = std::clamp(trim.dado, y0, y1);
  if (y > y0) b.panel(x0, y0, x1, y, trim.dado_material);
  if (y1 > y) b.panel(x0, y, x1, y1, e.material);
}

/// The wall around its openings, and what lies within its thickness.
void build_panels(Set& set, const Plan& plan, const Edge& e, const Trim& trim) {
  Builder b = set.solid(e.frame);
  std::vector<Opening> openings = e.openings;
  std::sort(openings.begin(), openings.end(),
            [](const Opening& p, const Opening& q) { return p.from < q.from; });
  float x = 0;
  const auto solid = [&](float to) {
    if (to <= x) return;
    wall_panel(b, e, trim, x, 0, to, plan.height);
    if (trim.skirting > 0) b.box({x, 0, 0}, {to, trim.skirting, 0.014f}, set.style.trim, 0.004f);
  };
  for (const Opening& o : openings) {
    solid(o.from);
    x = o.to;
    if (o.bottom > 0) wall_panel(b, e, trim, o.from, 0, o.to, o.bottom);
    if (o.top < plan.height) wall_panel(b, e, trim, o.from, o.top, o.to, plan.height);
    const bool window = o.kind == Opening::window;
    const float deep = -set.style.wall * (window ? 1.f : 0.5f);
    const int side = window ? e.material : set.style.trim;
    b.sheet({o.from, o.bottom, deep}, {0, 0, -deep}, {0, o.top - o.bottom, 0}, side);
    b.sheet({o.to, o.bottom, 0}, {0, 0, deep}, {0, o.top - o.bottom, 0}, side);
    b.sheet({o.from, o.top, 0}, {o.to - o.from, 0, 0}, {0, 0, deep}, side);
    b.sheet({o.from, o.bottom, deep}, {o.to - o.from, 0, 0}, {0, 0, -deep},
            window ? set.style.frame : plan.floor);
  }
  solid(e.length);
  if (trim.cornice > 0) {
    b.box({0, plan.height - trim.cornice, 0}, {e.length, plan.height, trim.cornice}, set.style.trim,
          trim.cornice * 0.4f);
  }
}

/// Boards around a hole: left, right, top and, for windows, below.
void build_frame(Builder b, const Opening& o, float wide, float z0, float z1, int material,
                 bool below) {
  b.box({o.from - wide, o.bottom, z0}, {o.from, o.top + wide, z1}, material, 0.004f);
  b.box({o.to, o.bottom, z0}, {o.to + wide, o.top + wide, z1}, material, 0.004f);
  b.box({o.from, o.top, z0}, {o.to, o.top + wide, z1}, material, 0.004f);
  if (below)
    b.box({o.from - wide, o.bottom - wide, z0}, {o.to + wide, o.bottom, z1}, material, 0.004f);
}

/// A leaf whose hinge is at the frame's origin, to the right along x.
void build_leaf(Set& set, Dice& d, Builder b, float width, float height, int material) {
  b.box({0, 0.01f, -0.04f}, {width, height, 0}, material, 0.003f);
  const int style = d.below(4);
  if (style == 0) {
    for (const float y : {0.12f, 0.55f}) {
      for (const float z : {-0.05f, 0.f}) {
        b.box({0.12f * width, y * height, z}, {0.88f * width, (y + 0.36f) * height, z + 0.01f},
              material, 0.01f);
      }
    }
  } else if (style == 1) {
    const int pane = set.add(plain(srgb(0.55f, 0.6f, 0.6f), 0.08f));
    b.box({0.2f * width, 0.5f * height, -0.045f}, {0.8f * width, 0.9f * height, 0.005f}, pane);
  }
  for (const float side : {-1.f, 1.f}) {
    const float z = side > 0 ? 0.f : -0.04f;
    const Vec at{width - 0.07f, 1.02f, z};
    b.rod(at, at + Vec{0, 0, side * 0.05f}, 0.01f, set.style.metal);
    b.rod(at + Vec{0, 0, side * 0.05f}, at + Vec{-0.11f, 0, side * 0.05f}, 0.01f, set.style.metal);
  }
}

void build_door(Set& set, Dice& d, const Edge& e, const Opening& o) {
  Builder b = set.solid(e.frame);
  build_frame(b, o, 0.07f, -0.01f, 0.02f, set.style.trim, false);
  if (o.kind == Opening::archway) return;
  if (o.kind == Opening::open_door && (o.behind || d.chance(0.15f))) return;
  if (o.kind == Opening::closed_door) {  // nobody looks through its gaps
    b.sheet({o.from, 0, -set.style.wall}, {o.to - o.from, 0, 0}, {0, o.top, 0}, set.style.dark);
  }
  const float width = o.to - o.from;
  const bool two = width > 1.15f, hinge_left = d.chance(0.5f);
  const float leaf = two ? width / 2 : width;
  const bool inwards = d.chance(0.6f);
  const float depth = inwards ? 0.f : -set.style.wall;
  for (int side = 0; side < (two ? 2 : 1); ++side) {
    const bool left = two ? side == 0 : hinge_left;
    float angle = 0;
    if (o.kind == Opening::open_door) {
      angle = d.chance(0.6f) ? d.range(1.2f, 1.75f) : d.range(0.15f, 1.2f);
    }
    // Inwards, the free end goes towards +z.
    const float turn = (inwards ? -angle : angle);
    Frame f = turned(left ? turn : 3.14159265f - turn, {left ? o.from : o.to, 0, depth});
    if (!left) f.ez = -f.ez;  // mirrored: the leaf's thickness stays within the wall
    build_leaf(set, d, b.in(f), leaf - 0.005f, o.top, set.style.door);
  }
  const Vec low = e.frame.point({o.from, 0, 0}),
            high = e.frame.point({o.to, 0, inwards ? leaf : 0.05f});
  set.footprints.push_back({{std::min(low.x, high.x), std::min(low.z, high.z),
                             std::max(low.x, high.x), std::max(low.z, high.z)},
                            0,
                            2.2f});
}

void build_curtains(Set& set, Dice& d, Builder b, const Opening& o, int material) {
  const float wide = o.to - o.from;
  const float low = d.chance(0.6f) ? 0.03f : o.bottom - 0.1f, high = o.top + 0.12f;
  const float share = d.range(0.12f, 0.45f);
  for (int side = 0; side < 2; ++side) {
    if (d.chance(0.15f)) continue;
    const float w = wide * share * d.range(0.7f, 1.2f);
    const float x = side == 0 ? o.from - 0.15f : o.to + 0.15f - w;
    b.curtain({x, low, 0.09f}, w, high - low, d.range(0.02f, 0.05f),
              std::max(2, static_cast<int>(w / 0.09f)), material, d.range(0, 6));
  }
  b.rod({o.from - 0.25f, high, 0.09f}, {o.to + 0.25f, high, 0.09f}, 0.012f, set.style.metal);
}

void build_blinds(Set& set, Dice& d, Builder b, const Opening& o) {
  const int material = set.add(plain(paint(d)));
  const float drop = (o.top - o.bottom) * d.range(0.15f, 0.9f);
  if (d.chance(0.5f)) {
    b.sheet({o.from + 0.03f, o.top - drop, -0.03f}, {o.to - o.from - 0.06f, 0, 0}, {0, drop, 0},
            material);
    return;
  }
  const float tilt = d.range(-0.02f, 0.02f);
  for (float y = o.top - 0.02f; y > o.top - drop; y -= 0.04f) {
    b.sheet({o.from + 0.03f, y, -0.05f}, {o.to - o.from - 0.06f, 0, 0}, {0, tilt, 0.035f},
            material);
  }
}

void build_window(Set& set, Dice& d, const Edge& e, const Opening& o, int curtain, bool blinds) {
  Builder b = set.solid(e.frame);
  const int m = set.style.frame;
  const float w = set.style.wall, wide = o.to - o.from, high = o.top - o.bottom;
  const float z1 = -0.5f * w, z0 = z1 - 0.05f, bar = 0.05f;
  b.box({o.from, o.bottom, z0}, {o.from + bar, o.top, z1}, m);
  b.box({o.to - bar, o.bottom, z0}, {o.to, o.top, z1}, m);
  b.box({o.from, o.bottom, z0}, {o.to, o.bottom + bar, z1}, m);
  b.box({o.from, o.top - bar, z0}, {o.to, o.top, z1}, m);
  const int columns = std::max(1, static_cast<int>(wide / 0.8f + 0.4f));
  for (int i = 1; i < columns; ++i) {
    const float x = o.from + wide * static_cast<float>(i) / static_cast<float>(columns);
    b.box({x - bar * 0.6f, o.bottom, z0}, {x + bar * 0.6f, o.top, z1}, m);
  }
  if (high > 1.2f && hash(static_cast<int>(wide * 100), 3, 9) < 0.4f) {
    const float y = o.bottom + 0.7f * high;
    b.box({o.from, y - 0.025f, z0}, {o.to, y + 0.025f, z1}, m);
  }
  if (o.bottom > 0.4f) {
    b.box({o.from - 0.05f, o.bottom - 0.03f, z1}, {o.to + 0.05f, o.bottom, 0.06f}, m, 0.004f);
    set.tops.push_back(
        {e.frame *
             Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {(o.from + o.to) / 2, o.bottom, -0.2f * w}},
         wide * 0.9f, 0.5f * w + 0.05f, 0.4f});
  }
  if (blinds) build_blinds(set, d, b, o);
  if (curtain >= 0) build_curtains(set, d, b, o, curtain);
}

void build_radiator(Set& set, Dice& d, const Edge& e, const Opening& o) {
  const float high = std::min(o.bottom - 0.2f, d.range(0.4f, 0.7f));
  const float wide = (o.to - o.from) * d.range(0.6f, 0.95f), x = (o.from + o.to - wide) / 2;
  Builder b = set.solid(e.frame);
  const int m = set.style.white;
  if (d.chance(0.5f)) {
    b.box({x, 0.12f, 0.04f}, {x + wide, 0.12f + high, 0.1f}, m, 0.01f);
    for (float u = x + 0.03f; u < x + wide - 0.02f; u += 0.05f) {
      b.box({u, 0.15f, 0.1f}, {u + 0.025f, 0.09f + high, 0.108f}, m);
    }
  } else {
    for (float u = x; u < x + wide; u += 0.06f) {
      b.box({u, 0.1f, 0.04f}, {u + 0.04f, 0.1f + high, 0.15f}, m, 0.015f);
    }
    b.rod({x, 0.15f, 0.09f}, {x + wide, 0.15f, 0.09f}, 0.015f, m);
    b.rod({x, 0.05f + high, 0.09f}, {x + wide, 0.05f + high, 0.09f}, 0.015f, m);
  }
  b.rod({x - 0.05f, 0, 0.08f}, {x - 0.05f, 0.2f, 0.08f}, 0.012f, m);
  const Vec p = e.frame.point({x, 0, 0}), q = e.frame.point({x + wide, 0, 0.2f});
  set.footprints.push_back(
      {{std::min(p.x, q.x), std::min(p.z, q.z), std::max(p.x, q.x), std::max(p.z, q.z)}, 0, 0.9f});
}

void light_windows(Set& set, const Edge& e) {
  LightGroup g;
  g.radiance = mix(set.scene.sky.horizon, set.scene.sky.zenith, 0.4f) * 0.7f;
  for (const Opening& o : e.openings) {
    if (o.kind != Opening::window) continue;
    const Vec u = e.frame.ex * ((o.to - o.from) * 0.5f), v = Vec{0, (o.top - o.bottom) * 0.5f, 0};
    g.add({e.frame.point(
               {(o.from + o.to) / 2, (o.top + o.bottom) / 2, -0.5f * set.style.wall - 0.08f}),
           u, v, e.frame.ez});
  }
  if (!g.emitters.empty()) set.add(g);
}

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

/// Pipes, ducts or rails below the ceiling.
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

/// Part of the floor is of another kind.
void build_floor_zone(Set& set, Dice& d, const Plan& plan) {
  Rect r = plan.rects[0];
  const float share = d.range(0.25f, 0.7f);
  if (d.chance(0.5f)) {
    r.x1 = r.x0 + share * r.width();
  } else {
    r.z0 = r.z1 - share * r.depth();
  }
  set.solid(Frame{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 0.001f, 0}})
      .panel(r.x0, -r.z1, r.x1, -r.z0, set.add(floor_material(d, plan.kind)));
}

}  // namespace

void build_walls(Set& set, Plan& plan, bool first) {
  Dice d = set.dice.child();
  const Vec color = paint(d);
  const int wall = set.add(wall_material(d, color));
  const int accent =
      d.chance(0.3f) ? set.add(wall_material(d, d.chance(0.5f) ? any_color(d) : paint(d))) : wall;
  plan.floor = set.add(floor_material(d, plan.kind));
  Material ceiling =
      wall_material(d, hsv(d.range(0, 0.2f), d.range(0, 0.05f), d.range(0.75f, 0.98f)));
  const float kind = d.unit();
  if (kind < 0.7f || ceiling.pattern != Pattern::plaster) {
    ceiling.pattern = Pattern::plaster;
    ceiling.amount = d.range(0, 0.5f);
  }
  if (kind > 0.85f) {
    ceiling.pattern = Pattern::tiles;
    ceiling.scale = 0.6f;
    ceiling.second = ceiling.color * 0.7f;
  } else if (kind > 0.78f) {
    ceiling.color = any_color(d);
  }
  plan.ceiling = set.add(ceiling);
  for (const Rect& r : plan.rects) {
    set.solid(Frame{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}})
        .panel(r.x0, -r.z1, r.x1, -r.z0, plan.floor);
    set.solid(Frame{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, plan.height, 0}})
        .panel(r.x0, r.z0, r.x1, r.z1, plan.ceiling);
  }
  Trim trim;
  if (d.chance(0.8f)) trim.skirting = d.range(0.05f, 0.15f);
  if (d.chance(0.15f)) trim.cornice = d.range(0.04f, 0.12f);
  if (d.chance(0.15f)) {
    trim.dado = d.range(0.8f, 1.6f);
    trim.dado_material = set.add(wall_material(d, d.chance(0.5f) ? any_color(d) : paint(d)));
  }
  const int curtain = d.chance(0.4f) ? set.add(cloth(d)) : -1;
  const bool blinds = d.chance(0.3f), radiators = d.chance(0.6f);
  const int tall = d.below(static_cast<int>(plan.edges.size()));
  for (std::size_t k = 0; k < plan.edges.size(); ++k) {
    Edge& e = plan.edges[k];
    e.material = static_cast<int>(k) == tall ? accent : wall;
    build_panels(set, plan, e, trim);
    for (const Opening& o : e.openings) {
      if (o.kind == Opening::window) {
        build_window(set, d, e, o, curtain, blinds);
        if (radiators && o.bottom > 0.65f) build_radiator(set, d, e, o);
      } else {
        build_door(set, d, e, o);
      }
    }
    light_windows(set, e);
  }
  if (d.chance(0.12f) || (plan.kind == RoomKind::hall && d.chance(0.3f))) build_beams(set, d, plan);
  if (d.chance(0.25f)) build_ducts(set, d, plan);
  if (d.chance(0.15f)) build_floor_zone(set, d, plan);
  bool day = luminance(set.scene.sky.horizon) > 0.1f, window = false;
  for (const Edge& e : plan.edges) {
    for (const Opening& o : e.openings) window |= o.kind == Opening::window;
  }
  light_ceiling(set, d, plan, d.chance(day && window ? 0.6f : first ? 1.f : 0.9f));
}

}  // namespace ps::rooms
