// SPDX-License-Identifier: BSD-3-Clause
// Tables, shelves, cupboards.
#include "libps/rooms/pieces.h"

namespace ps::rooms {
namespace {

/// Books side by side, from x = 0, their backs at z = 0 towards the front.
void books(Set& set, Dice& d, Builder b, float width, float height, float depth) {
  float x = 0;
  int covers[6];
  for (int& c : covers) c = set.add(plain(any_color(d)));
  while (x < width) {
    const float thick = d.range(0.012f, 0.06f), tall = height * d.range(0.6f, 0.97f);
    if (x + thick > width) break;
    if (d.chance(0.06f)) {
      x += d.range(0.03f, 0.2f);
      continue;
    }
    const float lean = d.chance(0.05f) ? 0.15f : 0;
    const float back = d.range(0.6f, 0.95f) * depth;
    b.in(tilted_z(-lean, {x, 0, 0}))
        .box({0, 0, -depth}, {thick, tall, -depth + back}, covers[d.below(6)]);
    x += thick + lean * tall;
  }
}

void screen(Set& set, Dice& d, Builder b, float width) {
  const float high = width * 0.58f;
  const int dark = set.style.dark;
  b.box({-width / 2, 0.12f, -0.02f}, {width / 2, 0.12f + high, 0.02f}, dark, 0.006f);
  int shown;
  if (d.chance(0.6f)) {
    Material m = plain({0.6f, 0.6f, 0.6f}, 0.05f);
    m.pattern = Pattern::picture;
    m.picture = set.add(poster(d, 96, 64));
    m.emission = Vec{1, 1, 1} * d.range(0.1f, 0.7f);
    shown = set.add(m);
  } else {
    shown = set.add(plain(srgb(0.06f, 0.06f, 0.07f), 0.06f));
  }
  const float e = 0.012f;
  b.picture({-width / 2 + e, 0.12f + e, 0.0205f}, {width - 2 * e, 0, 0}, {0, high - 2 * e, 0},
            shown);
  b.box({-0.03f, 0, -0.05f}, {0.03f, 0.2f, -0.02f}, dark);
  b.box({-0.12f, 0, -0.1f}, {0.12f, 0.012f, 0.08f}, dark, 0.004f);
}

}  // namespace

Piece table(Set& set, Dice& d, bool low) {
  const float w = low ? d.range(0.5f, 1.3f) : d.range(0.7f, 2.6f),
              depth = low ? d.range(0.4f, 0.8f) : d.range(0.6f, 1.1f);
  const float high = low ? d.range(0.3f, 0.55f) : d.range(0.68f, 0.78f),
              thick = d.range(0.015f, 0.06f);
  const int top = set.add(surface(d)), legs = d.chance(0.6f)   ? top
                                              : d.chance(0.5f) ? set.style.metal
                                                               : set.style.dark;
  const int style = d.below(4);
  const bool under = low && d.chance(0.4f);
  return {{w, high, depth}, [=](Set& s, Builder b) {
            b.box({-w / 2, high - thick, -depth / 2}, {w / 2, high, depth / 2}, top, 0.006f);
            const float x = w / 2 - 0.06f, z = depth / 2 - 0.06f, h = high - thick;
            if (style == 0) {
              for (const float p : {-1.f, 1.f}) {
                b.box({p * x - 0.02f, 0, -z}, {p * x + 0.02f, h, z}, legs);
              }
            } else if (style == 1) {
              for (const float p : {-1.f, 1.f}) {
                b.box({p * x - 0.03f, 0, -z}, {p * x + 0.03f, 0.04f, z}, legs, 0.01f);
                b.box({p * x - 0.03f, 0, -0.04f}, {p * x + 0.03f, h, 0.04f}, legs);
              }
              b.box({-x, h * 0.6f, -0.02f}, {x, h * 0.6f + 0.05f, 0.02f}, legs);
            } else {
              const float r = style == 2 ? 0.02f : 0.035f;
              for (const float p : {-1.f, 1.f}) {
                for (const float q : {-1.f, 1.f})
                  b.box({p * x - r, 0, q * z - r}, {p * x + r, h, q * z + r}, legs, 0.003f);
              }
              b.box({-x, h - 0.07f, -z}, {x, h, z}, legs);
            }
            if (under) {
              b.box({-x, 0.12f, -z}, {x, 0.14f, z}, top);
              add_top(s, b, {0, 0.14f, 0}, 1.8f * x, 1.8f * z, high - 0.2f);
            }
            add_top(s, b, {0, high, 0}, w, depth, 0.5f);
          }};
}

Piece round_table(Set& set, Dice& d) {
  const float r = d.range(0.3f, 0.7f),
              high = d.chance(0.8f) ? d.range(0.68f, 0.78f) : d.range(0.4f, 1.1f);
  const int top = set.add(surface(d)), foot = d.chance(0.5f) ? top : set.style.metal;
  return {{2 * r, high, 2 * r}, [=](Set& s, Builder b) {
            b.cylinder({0, high - 0.03f, 0}, r, 0.03f, top, -1, 24);
            b.cylinder({0, 0, 0}, r * 0.55f, 0.03f, foot, r * 0.5f, 16);
            b.cylinder({0, 0, 0}, 0.04f, high - 0.03f, foot, -1, 10);
            add_top(s, b, {0, high, 0}, 1.3f * r, 1.3f * r, 0.5f);
          }};
}

Piece desk(Set& set, Dice& d) {
  const float w = d.range(1.1f, 1.9f), depth = d.range(0.6f, 0.85f), high = d.range(0.7f, 0.77f);
  const int top = set.add(surface(d)), legs = d.chance(0.4f) ? top : set.style.metal,
            front = set.add(surface(d));
  const bool drawers = d.chance(0.5f), panel = d.chance(0.3f);
  const int screens = d.pick({0, 1, 1, 1, 2, 2});
  const float size = d.range(0.42f, 0.65f);
  Dice own = d.child();
  return {{w, high + 0.45f, depth}, [=](Set& s, Builder b) mutable {
            const float x = w / 2 - 0.05f, z = depth / 2 - 0.05f;
            b.box({-w / 2, high - 0.03f, -depth / 2}, {w / 2, high, depth / 2}, top, 0.005f);
            for (const float p : {-1.f, 1.f}) {
              b.box({p * x - 0.03f, 0, -z}, {p * x + 0.03f, 0.03f, z}, legs);
              b.box({p * x - 0.025f, 0, -0.05f}, {p * x + 0.025f, high - 0.03f, 0.05f}, legs);
            }
            if (panel) b.box({-x, 0.3f, -z}, {x, high - 0.03f, -z + 0.02f}, front);
            if (drawers) {
              const float u = own.sign() * (x - 0.25f);
              b.box({u - 0.2f, 0.05f, -z + 0.05f}, {u + 0.2f, 0.6f, z - 0.02f}, front);
              fronts(b.in(at(0, 0, z - 0.02f)), own, u - 0.2f, 0.06f, u + 0.2f, 0.59f, own.below(2),
                     front, s.style.metal);
            }
            for (int i = 0; i < screens; ++i) {
              const float u =
                  (static_cast<float>(i) - 0.5f * static_cast<float>(screens - 1)) * (size + 0.05f);
              screen(s, own, b.in(turned(-u * 0.4f, {u, high, -depth / 2 + 0.2f})), size);
            }
            if (screens > 0) {
              const int keys = own.chance(0.7f) ? s.style.dark : s.style.white;
              b.box({-0.22f, high, 0.05f}, {0.22f, high + 0.018f, 0.19f}, keys, 0.005f);
              b.cushion({0.28f, high, 0.07f}, {0.34f, high + 0.035f, 0.17f}, keys, 0.8f, 5);
            }
            add_top(s, b, {-w * 0.35f, high, 0}, w * 0.28f, depth * 0.9f, 0.4f);
            add_top(s, b, {w * 0.37f, high, 0}, w * 0.22f, depth * 0.9f, 0.4f);
          }};
}

Piece shelf(Set& set, Dice& d) {
  const float w = d.range(0.5f, 2),
              high = d.chance(0.6f) ? d.range(1.5f, 2.2f) : d.range(0.7f, 1.4f),
              depth = d.range(0.24f, 0.42f);
  const int body = set.add(surface(d)), back = d.chance(0.7f) ? body : -1;
  const int rows = std::max(2, static_cast<int>(high / d.range(0.28f, 0.42f)));
  const int columns = std::max(1, static_cast<int>(w / d.range(0.4f, 1) + 0.4f));
  const float full = d.range(0.2f, 1), booky = d.unit();
  Dice own = d.child();
  return {{w, high, depth}, [=](Set& s, Builder b) mutable {
            const float t = 0.02f, z = depth / 2;
            for (int i = 0; i <= columns; ++i) {
              const float x =
                  mix(-w / 2, w / 2 - t, static_cast<float>(i) / static_cast<float>(columns));
              b.box({x, 0, -z}, {x + t, high, z}, body, 0.002f);
            }
            if (back >= 0)
              b.sheet({-w / 2, 0.04f, -z + 0.005f}, {w, 0, 0}, {0, high - 0.05f, 0}, back);
            const float pitch = (high - 0.08f) / static_cast<float>(rows),
                        cell = w / static_cast<float>(columns);
            for (int j = 0; j <= rows; ++j) {
              const float y = 0.05f + pitch * static_cast<float>(j);
              b.box({-w / 2, y, -z}, {w / 2, y + t, z - 0.005f}, body, 0.002f);
              for (int i = 0; j < rows && i < columns; ++i) {
                if (!own.chance(full)) continue;
                const float x0 = -w / 2 + cell * static_cast<float>(i) + t;
                if (own.chance(booky)) {
                  books(s, own, b.in(at(x0, y + t, z - 0.02f)), (cell - 2 * t) * own.range(0.4f, 1),
                        pitch - 2 * t, depth - 0.04f);
                } else {
                  strew(s, own,
                        {b.frame() * at(x0 + cell / 2, y + t, 0), cell - 0.06f, depth - 0.04f,
                         pitch - 0.04f},
                        own.unit());
                }
              }
            }
            add_top(s, b, {0, high, 0}, w, depth, 0.3f);
          }};
}

Piece cupboard(Set& set, Dice& d, float low, float tall) {
  const float w = d.range(0.4f, tall > 1.5f ? 2.2f : 1.8f), high = d.range(low, tall);
  const float depth = tall > 1.5f ? d.range(0.35f, 0.65f) : d.range(0.3f, 0.5f);
  const int body = set.add(surface(d)), front = d.chance(0.6f) ? body : set.add(surface(d));
  const int grip = d.chance(0.6f) ? set.style.metal : set.style.dark, style = d.below(3);
  const float plinth = d.chance(0.7f) ? d.range(0.03f, 0.1f) : 0,
              legs = plinth > 0 ? 0 : d.range(0.08f, 0.2f);
  const bool shutter = d.chance(0.12f);
  Material slats = plain(srgb(0.5f, 0.5f, 0.52f));
  slats.pattern = Pattern::grooves;
  slats.scale = 0.02f;
  const int shut = set.add(slats);
  Dice own = d.child();
  return {{w, high, depth}, [=](Set& s, Builder b) mutable {
            const float z = depth / 2, y0 = plinth + legs;
            if (plinth > 0)
              b.box({-w / 2 + 0.01f, 0, -z}, {w / 2 - 0.01f, plinth, z - 0.04f}, s.style.dark);
            for (const float p : {-1.f, 1.f}) {
              for (const float q : {-1.f, 1.f}) {
                if (legs > 0)
                  b.rod({p * (w / 2 - 0.05f), 0, q * (z - 0.05f)},
                        {p * (w / 2 - 0.05f), y0, q * (z - 0.05f)}, 0.014f, grip);
              }
            }
            b.box({-w / 2, y0, -z}, {w / 2, high, z - 0.02f}, body, 0.002f);
            Builder face = b.in(at(0, 0, z - 0.02f));
            if (shutter) {
              face.in({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0.005f}})
                  .panel(-w / 2 + 0.03f, y0 + 0.03f, w / 2 - 0.03f, high - 0.05f, shut);
            } else {
              fronts(face, own, -w / 2, y0, w / 2, high - 0.02f, style, front, grip);
            }
            b.box({-w / 2 - 0.005f, high - 0.018f, -z}, {w / 2 + 0.005f, high, z + 0.005f}, body,
                  0.003f);
            add_top(s, b, {0, high, 0}, w, depth, high < 1.5f ? 0.5f : 0.25f);
          }};
}

}  // namespace ps::rooms
