// SPDX-License-Identifier: BSD-3-Clause
// Kitchens, and fronts as kitchens and cupboards have them.
#include "libps/rooms/pieces.h"

namespace ps::rooms {
namespace {

void handle(Builder b, float x, float y, bool upright, int style, int material) {
  if (style == 0) {
    const Vec half = upright ? Vec{0, 0.07f, 0} : Vec{0.07f, 0, 0};
    const Vec p{x, y, 0.025f};
    b.rod(p - half, p + half, 0.006f, material);
    b.rod(p - half, p - half - Vec{0, 0, 0.025f}, 0.006f, material, 4);
    b.rod(p + half, p + half - Vec{0, 0, 0.025f}, 0.006f, material, 4);
  } else if (style == 1) {
    b.ball({x, y, 0.02f}, 0.016f, material, 5);
  }
}

}  // namespace

void add_top(Set& set, const Builder& b, Vec middle, float width, float depth, float room) {
  set.tops.push_back({b.frame() * at(middle.x, middle.y, middle.z), width, depth, room});
}

void fronts(Builder b, Dice& d, float x0, float y0, float x1, float y1, int style, int front,
            int grip) {
  const float wide = d.range(0.35f, 0.65f);
  const int columns = std::max(1, static_cast<int>((x1 - x0) / wide + 0.5f));
  for (int i = 0; i < columns; ++i) {
    const float a = mix(x0, x1, static_cast<float>(i) / static_cast<float>(columns)) + 0.002f;
    const float c = mix(x0, x1, static_cast<float>(i + 1) / static_cast<float>(columns)) - 0.002f;
    const int drawers = y1 - y0 < 1.1f && d.chance(0.4f) ? d.whole(2, 4) : 1;
    for (int j = 0; j < drawers; ++j) {
      const float p = mix(y0, y1, static_cast<float>(j) / static_cast<float>(drawers)) + 0.002f;
      const float q = mix(y0, y1, static_cast<float>(j + 1) / static_cast<float>(drawers)) - 0.002f;
      b.box({a, p, 0}, {c, q, 0.018f}, front, 0.003f);
      Builder face = b.in(at(0, 0, 0.018f));
      if (drawers > 1) {
        handle(face, (a + c) / 2, q - 0.06f, false, style, grip);
      } else {
        handle(face, i % 2 == 0 ? c - 0.05f : a + 0.05f, mix(p, q, 0.55f), true, style, grip);
      }
    }
  }
}

Piece fridge(Set& set, Dice& d) {
  const float high = d.range(0.85f, 2), w = d.range(0.55f, 0.7f);
  Material m = d.chance(0.5f) ? metal(d) : plain(any_color(d), 0.04f);
  m.gloss = std::min(m.gloss, 0.25f);
  const int body = set.add(m);
  return {{w, high, 0.62f}, [=](Set& s, Builder b) {
            b.box({-w / 2, 0.03f, -0.31f}, {w / 2, high, 0.25f}, body, 0.01f);
            const float split = high > 1.3f ? high * 0.36f : high * 0.97f;
            b.box({-w / 2, 0.05f, 0.255f}, {w / 2, split, 0.31f}, body, 0.015f);
            if (high > 1.3f)
              b.box({-w / 2, split + 0.01f, 0.255f}, {w / 2, high, 0.31f}, body, 0.015f);
            b.rod({-w / 2 + 0.06f, split + 0.08f, 0.34f}, {-w / 2 + 0.06f, split + 0.4f, 0.34f},
                  0.01f, s.style.metal);
            add_top(s, b, {0, high, 0}, w, 0.5f, 0.3f);
          }};
}

Piece kitchen_row(Set& set, Dice& d, float width) {
  const int front = set.add(surface(d)),
            worktop = set.add(d.chance(0.5f) ? wood_material(d) : surface(d));
  Material splash =
      d.chance(0.5f) ? plain(any_color(d), 0.06f) : floor_material(d, RoomKind::bathroom);
  if (splash.pattern == Pattern::planks) splash.pattern = Pattern::tiles;
  splash.scale = std::min(splash.scale, 0.15f);
  const int back = set.add(splash), style = d.below(3), upper = d.chance(0.75f) ? 1 : 0;
  const float above = d.range(1.35f, 1.5f), upper_high = d.range(0.5f, 0.85f);
  Dice own = d.child();
  return {{width, upper ? above + upper_high : 0.92f, 0.62f}, [=](Set& s, Builder b) mutable {
            const float x = width / 2, z = 0.31f;
            b.box({-x, 0, -z}, {x, 0.1f, z - 0.06f}, s.style.dark);
            b.box({-x, 0.1f, -z}, {x, 0.87f, z - 0.03f}, front);
            fronts(b.in(at(0, 0, z - 0.03f)), own, -x, 0.1f, x, 0.86f, style, front, s.style.metal);
            b.box({-x, 0.87f, -z}, {x, 0.91f, z}, worktop, 0.004f);
            b.in(at(0, 0, -z + 0.004f)).panel(-x, 0.91f, x, above, back);
            const float sink = own.range(-x + 0.4f, x - 0.4f);
            b.box({sink - 0.25f, 0.905f, -0.2f}, {sink + 0.25f, 0.914f, 0.2f}, s.style.metal);
            b.box({sink - 0.2f, 0.9f, -0.15f}, {sink + 0.2f, 0.916f, 0.15f}, s.style.dark);
            b.rod({sink, 0.91f, -0.22f}, {sink, 1.15f, -0.22f}, 0.014f, s.style.metal, 8);
            b.rod({sink, 1.15f, -0.22f}, {sink, 1.12f, -0.05f}, 0.012f, s.style.metal, 8);
            const float hob = sink > 0 ? sink - 0.9f : sink + 0.9f;
            if (std::abs(hob) < x - 0.3f) {
              b.box({hob - 0.28f, 0.91f, -0.24f}, {hob + 0.28f, 0.918f, 0.24f}, s.style.dark);
              b.box({hob - 0.28f, 0.2f, z - 0.03f}, {hob + 0.28f, 0.8f, z - 0.005f}, s.style.dark,
                    0.005f);
            }
            if (upper) {
              const float open = own.chance(0.4f) ? own.range(0.3f, 0.8f) : 0;
              b.box({-x + open, above, -z}, {x, above + upper_high, 0.02f}, front);
              fronts(b.in(at(0, 0, 0.02f)), own, -x + open, above, x, above + upper_high, style,
                     front, s.style.metal);
            }
            add_top(s, b, {-x * 0.5f, 0.91f, -0.05f}, x * 0.8f, 0.4f, 0.4f);
            add_top(s, b, {x * 0.5f, 0.91f, -0.05f}, x * 0.8f, 0.4f, 0.4f);
          }};
}

Piece counter(Set& set, Dice& d) {
  const float w = d.range(1.2f, 3), high = d.range(0.9f, 1.15f), depth = d.range(0.5f, 0.9f);
  const int body = set.add(surface(d)), top = set.add(surface(d));
  return {{w, high, depth}, [=](Set& s, Builder b) {
            b.box({-w / 2 + 0.04f, 0, -depth / 2 + 0.04f},
                  {w / 2 - 0.04f, high - 0.04f, depth / 2 - 0.04f}, body, 0.003f);
            b.box({-w / 2, high - 0.04f, -depth / 2}, {w / 2, high, depth / 2}, top, 0.005f);
            add_top(s, b, {0, high, 0}, w, depth, 0.4f);
          }};
}

}  // namespace ps::rooms
