// SPDX-License-Identifier: BSD-3-Clause
// Floors, walls and ceilings.
#include <algorithm>

#include "libps/rooms/shell.h"

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
