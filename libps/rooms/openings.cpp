// SPDX-License-Identifier: BSD-3-Clause
// Doors and windows, and what belongs to them.
#include <algorithm>

#include "libps/rooms/shell.h"

namespace ps::rooms {
namespace {

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

}  // namespace

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

}  // namespace ps::rooms
