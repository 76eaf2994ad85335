// SPDX-License-Identifier: BSD-3-Clause
// Lamps, bins, boxes, bathrooms, bags.
#include "libps/rooms/pieces.h"

namespace ps::rooms {
Piece floor_lamp(Set& set, Dice& d) {
  const float high = d.range(1.2f, 1.9f), r = d.range(0.12f, 0.25f);
  const bool on = d.chance(0.5f);
  const Vec tint{1, d.range(0.7f, 0.95f), d.range(0.45f, 0.85f)};
  Material shade = plain(paint(d));
  if (on) shade.emission = tint * d.range(0.5f, 1.2f);
  const int glow = set.add(shade), foot = d.chance(0.5f) ? set.style.metal : set.style.dark;
  const float power = d.range(0.6f, 2.5f);
  return {{2 * r, high, 2 * r}, [=](Set& s, Builder b) {
            b.cylinder({}, r * 0.8f, 0.02f, foot);
            b.rod({}, {0, high - 0.15f, 0}, 0.012f, foot);
            s.lamps(b.frame()).lathe({0, high - 0.3f, 0}, {{r, 0}, {r * 0.7f, 0.3f}}, glow);
            if (!on) return;
            LightGroup g;
            const Vec c = b.frame().point({0, high - 0.15f, 0});
            g.add({c, {0.08f, 0, 0}, {}, {}, true});
            g.radiance = tint * (power / g.area * 0.3f);
            s.add(g);
          }};
}

Piece bin(Set& set, Dice& d) {
  const float r = d.range(0.11f, 0.2f), high = d.range(0.25f, 0.6f);
  const int m = set.add(plain(any_color(d), d.chance(0.3f) ? 0.05f : 0));
  const bool square = d.chance(0.3f);
  return {{2 * r, high, 2 * r}, [=](Set& s, Builder b) {
            if (square) {
              b.tapered({-r * 0.8f, 0, -r * 0.8f}, {r * 0.8f, high, r * 0.8f}, 1.2f, m);
            } else {
              b.lathe(
                  {},
                  {{0, 0}, {r * 0.8f, 0}, {r, high}, {r * 0.93f, high}, {r * 0.8f, high * 0.3f}},
                  m);
              b.cylinder({0, high * 0.3f, 0}, r * 0.8f, 0.01f, s.style.dark);
            }
          }};
}

Piece box_pile(Set& set, Dice& d) {
  const float w = d.range(0.25f, 0.6f), depth = d.range(0.25f, 0.5f);
  const int count = d.whole(1, 4);
  Dice own = d.child();
  float high = 0;
  std::vector<float> heights;
  for (int i = 0; i < count; ++i) heights.push_back(d.range(0.12f, 0.45f));
  for (const float h : heights) high += h;
  const bool card = d.chance(0.65f);
  const int m =
      set.add(plain(card ? hsv(d.range(0.06f, 0.1f), d.range(0.35f, 0.55f), d.range(0.5f, 0.75f))
                         : any_color(d)));
  const int tape = set.add(plain(hsv(0.09f, 0.3f, d.range(0.5f, 0.85f)), 0.03f));
  return {{w, high, depth}, [=](Set& s, Builder b) mutable {
            float y = 0;
            for (const float h : heights) {
              const float k = own.range(0.7f, 1);
              Builder p = b.in(turned(own.range(-0.2f, 0.2f), {0, y, 0}));
              p.box({-w / 2 * k, 0, -depth / 2 * k}, {w / 2 * k, h, depth / 2 * k}, m, 0.004f);
              p.box({-0.025f, 0.01f, -depth / 2 * k - 0.001f},
                    {0.025f, h + 0.001f, depth / 2 * k + 0.001f}, tape);
              if (own.chance(0.4f)) {
                p.picture({-w * 0.3f * k, h * 0.2f, depth / 2 * k + 0.002f}, {w * 0.25f, 0, 0},
                          {0, h * 0.4f, 0}, poster_material(s, own, 32));
              }
              y += h;
            }
          }};
}

Piece toilet(Set& set, Dice& d) {
  const int m = set.add(plain(srgb(0.93f, 0.93f, 0.92f), 0.05f));
  const float seat = d.range(0.39f, 0.45f);
  return {{0.38f, 0.85f, 0.68f}, [=](Set&, Builder b) {
            b.cushion({-0.18f, -0.1f, -0.2f}, {0.18f, seat, 0.34f}, m, 0.6f, 8);
            b.cushion({-0.19f, seat - 0.02f, -0.2f}, {0.19f, seat + 0.03f, 0.34f}, m, 0.6f, 8);
            b.box({-0.19f, 0.4f, -0.34f}, {0.19f, 0.82f, -0.17f}, m, 0.03f);
          }};
}

Piece bathtub(Set& set, Dice& d) {
  const float w = d.range(1.5f, 1.8f), high = d.range(0.5f, 0.62f);
  const int m = set.add(plain(srgb(0.93f, 0.93f, 0.92f), 0.05f)),
            side = d.chance(0.5f) ? m : set.add(floor_material(d, RoomKind::bathroom));
  return {{w, high, 0.75f}, [=](Set& s, Builder b) {
            const float x = w / 2, z = 0.375f, r = 0.06f;
            b.box({-x, 0, z - 0.02f}, {x, high - 0.03f, z}, side);
            b.box({-x, 0, -z}, {-x + 0.02f, high - 0.03f, z}, side);
            b.box({x - 0.02f, 0, -z}, {x, high - 0.03f, z}, side);
            b.box({-x, high - 0.03f, -z}, {x, high, -z + r}, m, 0.01f);
            b.box({-x, high - 0.03f, z - r}, {x, high, z}, m, 0.01f);
            b.box({-x, high - 0.03f, -z}, {-x + r, high, z}, m, 0.01f);
            b.box({x - r, high - 0.03f, -z}, {x, high, z}, m, 0.01f);
            b.sheet({-x, 0.15f, z}, {2 * x, 0, 0}, {0, 0, -2 * z}, m);
            for (const float p : {-1.f, 1.f}) {
              b.sheet({-x, 0.15f, p * (z - 2 * r)}, {2 * x, 0, 0}, {0, high - 0.16f, p * r}, m);
              b.sheet({p * (x - 3 * r), 0.15f, -z}, {0, 0, 2 * z}, {p * 2 * r, high - 0.16f, 0}, m);
            }
            b.rod({x - 0.1f, high, 0}, {x - 0.1f, high + 0.15f, 0}, 0.015f, s.style.metal);
            b.rod({x - 0.1f, high + 0.15f, 0}, {x - 0.25f, high + 0.12f, 0}, 0.013f, s.style.metal);
          }};
}

Piece basin(Set& set, Dice& d) {
  const int white = set.add(plain(srgb(0.93f, 0.93f, 0.92f), 0.05f)), body = set.add(surface(d));
  const float w = d.range(0.45f, 1.1f);
  const bool cabinet = d.chance(0.6f);
  return {{w, 0.9f, 0.45f}, [=](Set& s, Builder b) {
            if (cabinet) {
              b.box({-w / 2, 0.25f, -0.225f}, {w / 2, 0.76f, 0.2f}, body, 0.003f);
            } else {
              b.cylinder({0, 0, -0.08f}, 0.09f, 0.7f, white);
            }
            b.box({-w / 2, 0.76f, -0.225f}, {w / 2, 0.84f, 0.225f}, white, 0.02f);
            b.cylinder({0, 0.838f, 0.02f}, 0.15f, 0.005f, s.style.metal, 0.15f, 18);
            b.rod({0, 0.84f, -0.16f}, {0, 1, -0.16f}, 0.015f, s.style.metal, 8);
            b.rod({0, 0.98f, -0.16f}, {0, 0.95f, -0.03f}, 0.012f, s.style.metal, 8);
            s.tops.push_back({b.frame() * at(-w * 0.35f, 0.84f, -0.1f), w * 0.3f, 0.2f, 0.25f});
          }};
}

Piece stepladder(Set& set, Dice& d) {
  const float high = d.range(0.9f, 2), w = 0.45f;
  const int m = d.chance(0.6f) ? set.style.metal : set.add(plain(any_color(d)));
  return {{w, high, high * 0.5f}, [=](Set&, Builder b) {
            for (const float s : {-1.f, 1.f}) {
              b.rod({s * w / 2, 0, high * 0.25f}, {s * w * 0.35f, high, 0}, 0.018f, m);
              b.rod({s * w / 2, 0, -high * 0.25f}, {s * w * 0.35f, high, 0}, 0.015f, m);
            }
            for (float y = 0.22f; y < high; y += 0.24f) {
              const float k = 1 - y / high;
              b.box({-w * 0.42f, y, high * 0.25f * k - 0.05f},
                    {w * 0.42f, y + 0.03f, high * 0.25f * k + 0.03f}, m);
            }
          }};
}

Piece bag(Set& set, Dice& d) {
  const float w = d.range(0.25f, 0.5f), high = d.range(0.2f, 0.5f), depth = d.range(0.15f, 0.3f);
  const int m = set.add(cloth(d));
  const float soft = d.range(0.4f, 0.9f);
  return {{w, high, depth}, [=](Set&, Builder b) {
            b.cushion({-w / 2, -0.04f, -depth / 2}, {w / 2, high * 0.8f, depth / 2}, m, soft, 8);
            b.rod({-w * 0.2f, high * 0.7f, 0}, {-w * 0.1f, high, 0}, 0.01f, m);
            b.rod({-w * 0.1f, high, 0}, {w * 0.1f, high, 0}, 0.01f, m);
            b.rod({w * 0.1f, high, 0}, {w * 0.2f, high * 0.7f, 0}, 0.01f, m);
          }};
}

}  // namespace ps::rooms
