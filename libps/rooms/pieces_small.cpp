// SPDX-License-Identifier: BSD-3-Clause
// Plants, lamps, boxes, bathrooms, and what lies about.
#include "libps/rooms/pieces.h"

namespace ps::rooms {
namespace {

Frame at(float x, float y, float z) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {x, y, z}}; }

void leaves(Dice& d, Builder b, Vec from, float length, float width, int count, int material,
            float upright) {
  for (int i = 0; i < count; ++i) {
    const float a = d.range(0, 6.2831853f), rise = d.range(upright - 0.5f, upright + 0.4f);
    const float l = length * d.range(0.6f, 1.1f);
    const Vec along =
        Vec{std::cos(a) * std::cos(rise), std::sin(rise), std::sin(a) * std::cos(rise)} * l;
    const Vec across =
        Vec{-std::sin(a), d.range(-0.3f, 0.3f), std::cos(a)} * (width * d.range(0.7f, 1.2f));
    b.leaf(from + Vec{d.range(-1, 1) * 0.03f, 0, d.range(-1, 1) * 0.03f}, along, across,
           l * d.range(0.1f, 0.7f), material);
  }
}

int green(Set& set, Dice& d) {
  return set.add(plain(hsv(d.range(0.2f, 0.4f), d.range(0.3f, 0.8f), d.range(0.15f, 0.5f)),
                       d.chance(0.4f) ? 0.03f : 0));
}

void draw_plant(Dice& d, Builder b, float height, float radius, int pot, int soil, int leaf,
                int stem) {
  const float pot_high = height * d.range(0.18f, 0.35f),
              r = std::min(radius * 0.6f, pot_high * 0.7f);
  b.lathe({},
          {{r * 0.75f, 0},
           {r, pot_high},
           {r * 0.9f, pot_high},
           {r * 0.9f, pot_high * 0.9f},
           {0, pot_high * 0.9f}},
          pot);
  b.cylinder({0, pot_high * 0.85f, 0}, r * 0.9f, 0.01f, soil);
  const float high = height - pot_high;
  const int kind = d.below(4);
  const Vec root{0, pot_high * 0.9f, 0};
  if (kind == 0) {
    leaves(d, b, root, high * 1.1f, high * 0.18f, d.whole(15, 60), leaf, 1.1f);
  } else if (kind == 1) {  // crowns on stems
    const int stems = d.whole(1, 4);
    for (int i = 0; i < stems; ++i) {
      const Vec top{d.range(-0.4f, 0.4f) * radius, pot_high + high * d.range(0.35f, 0.85f),
                    d.range(-0.4f, 0.4f) * radius};
      b.rod(root, top, 0.012f + 0.01f * height, stem);
      leaves(d, b, top, radius * 1.1f, radius * 0.1f, d.whole(30, 110), leaf, 0.5f);
    }
  } else if (kind == 2) {  // leaves all along
    const int stems = d.whole(2, 6);
    for (int i = 0; i < stems; ++i) {
      const Vec top{d.range(-0.7f, 0.7f) * radius, height * d.range(0.7f, 1),
                    d.range(-0.7f, 0.7f) * radius};
      b.rod(root, top, 0.008f, stem, 5);
      for (int j = 0; j < 8; ++j)
        leaves(d, b, mix(root, top, d.range(0.2f, 1)), radius * 0.5f, radius * 0.28f, 2, leaf,
               0.2f);
    }
  } else {  // stiff blades
    leaves(d, b, root, high, 0.06f + 0.03f * height, d.whole(8, 20), leaf, 1.4f);
  }
}

void paper(Set& set, Dice& d, Builder b) {
  Material m = plain(srgb(0.93f, 0.93f, 0.9f));
  m.pattern = Pattern::text;
  m.second = srgb(0.2f, 0.2f, 0.25f);
  m.scale = d.range(0.02f, 0.06f);
  m.seed = d.bits();
  const int page = d.chance(0.7f) ? set.add(m) : poster_material(set, d, 48);
  const int sheets = d.whole(1, 4);
  for (int i = 0; i < sheets; ++i) {
    Builder p = b.in(turned(
        d.range(-0.6f, 0.6f),
        {d.range(-0.05f, 0.05f), 0.002f + 0.002f * static_cast<float>(i), d.range(-0.05f, 0.05f)}));
    p.picture({-0.105f, 0, 0.148f}, {0.21f, 0, 0}, {0, 0, -0.297f}, page);
  }
}

}  // namespace

Piece plant(Set& set, Dice& d) {
  const float high = d.range(0.5f, 2), r = high * d.range(0.2f, 0.4f);
  const int pot = set.add(surface(d)), soil = set.add(plain(srgb(0.2f, 0.15f, 0.1f))),
            leaf = green(set, d);
  const int stem = set.add(plain(srgb(0.35f, 0.28f, 0.18f)));
  Dice own = d.child();
  return {{1.2f * r, high, 1.2f * r},
          [=](Set&, Builder b) mutable { draw_plant(own, b, high, r, pot, soil, leaf, stem); }};
}

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

void clutter(Set& set, Dice& d, Builder b, float width, float depth, float height) {
  const float r = 0.5f * std::min(width, depth);
  const auto color = [&](float gloss = 0) { return set.add(plain(any_color(d), gloss)); };
  switch (d.below(11)) {
    case 0: {  // bottle
      const float h = std::min(height, d.range(0.18f, 0.33f)),
                  k = std::min(r, d.range(0.03f, 0.045f));
      b.lathe({}, {{0, 0}, {k, 0}, {k, h * 0.6f}, {k * 0.35f, h * 0.75f}, {k * 0.35f, h}, {0, h}},
              color(0.05f), 12);
      break;
    }
    case 1: {  // mug
      const float h = std::min(height, d.range(0.08f, 0.12f)),
                  k = std::min(r, d.range(0.03f, 0.05f));
      const int m = color(0.04f);
      b.lathe({}, {{0, 0}, {k, 0}, {k, h}, {k * 0.9f, h}, {k * 0.85f, 0.01f}}, m, 12);
      b.rod({k, h * 0.25f, 0}, {k * 1.6f, h * 0.5f, 0}, 0.006f, m, 5);
      b.rod({k * 1.6f, h * 0.5f, 0}, {k, h * 0.8f, 0}, 0.006f, m, 5);
      break;
    }
    case 2: {  // bowl, perhaps with fruit
      const float k = std::min(r, d.range(0.08f, 0.16f)), h = std::min(height, k * 0.6f);
      b.lathe({},
              {{k * 0.4f, 0},
               {k * 0.8f, h * 0.4f},
               {k, h},
               {k * 0.95f, h},
               {k * 0.7f, h * 0.4f},
               {0, h * 0.2f}},
              color(0.03f), 16);
      const int fruit = d.below(6),
                skin = set.add(
                    plain(hsv(d.range(0, 0.3f), d.range(0.6f, 0.9f), d.range(0.5f, 0.9f)), 0.02f));
      for (int i = 0; i < fruit; ++i) {
        const float a = d.range(0, 6.28f);
        b.ball({k * 0.45f * std::cos(a), h * 0.7f + 0.01f * static_cast<float>(i),
                k * 0.45f * std::sin(a)},
               0.035f, skin, 6);
      }
      break;
    }
    case 3:
    case 4: {  // books, flat
      float y = 0;
      const int count = d.whole(1, 5);
      for (int i = 0; i < count; ++i) {
        const float t = d.range(0.01f, 0.04f), w = std::min(width, d.range(0.13f, 0.24f)) / 2,
                    l = std::min(depth, d.range(0.18f, 0.3f)) / 2;
        if (y + t > height) break;
        Builder p = b.in(turned(d.range(-0.3f, 0.3f), {0, y, 0}));
        p.box({-w, 0, -l}, {w, t, l}, color());
        y += t;
      }
      break;
    }
    case 5:
      if (width > 0.25f && depth > 0.3f) paper(set, d, b);
      break;
    case 6: {  // box
      const float w = std::min(width, d.range(0.06f, 0.4f)) / 2,
                  l = std::min(depth, d.range(0.05f, 0.3f)) / 2,
                  h = std::min(height, d.range(0.04f, 0.3f));
      b.box({-w, 0, -l}, {w, h, l}, color(), 0.003f);
      if (d.chance(0.5f))
        b.picture({-w, 0, l + 0.001f}, {2 * w, 0, 0}, {0, h, 0}, poster_material(set, d, 32));
      break;
    }
    case 7: {  // vase or small plant
      if (height < 0.18f) break;
      const float h = std::min(height, d.range(0.18f, 0.5f));
      draw_plant(d, b, h, std::min(r * 1.3f, h * 0.5f), color(0.03f), set.style.dark, green(set, d),
                 set.style.dark);
      break;
    }
    case 8: {  // basket, crate
      const float w = std::min(width, d.range(0.2f, 0.45f)) / 2,
                  l = std::min(depth, d.range(0.15f, 0.35f)) / 2,
                  h = std::min(height, d.range(0.08f, 0.25f));
      const int m = set.add(cloth(d));
      b.box({-w, 0, -l}, {w, 0.01f, l}, m);
      b.box({-w, 0, -l}, {-w + 0.012f, h, l}, m);
      b.box({w - 0.012f, 0, -l}, {w, h, l}, m);
      b.box({-w, 0, -l}, {w, h, -l + 0.012f}, m);
      b.box({-w, 0, l - 0.012f}, {w, h, l}, m);
      const int inside = d.below(5);
      for (int i = 0; i < inside; ++i) {
        const float k = std::min(0.06f, h * 0.6f);
        b.ball({d.range(-w + k, w - k) * 0.9f, k + 0.02f * static_cast<float>(i),
                d.range(-l + k, l - k) * 0.9f},
               k, color(), 6);
      }
      break;
    }
    case 9: {  // cloth, thrown down
      const float w = std::min(width, d.range(0.15f, 0.5f)) / 2,
                  l = std::min(depth, d.range(0.15f, 0.4f)) / 2;
      b.cushion({-w, -0.03f, -l}, {w, std::min(height, d.range(0.03f, 0.15f)), l},
                set.add(cloth(d)), d.range(0.5f, 1), 8);
      break;
    }
    default: {  // frame on a stand, laptop
      const float w = std::min(width, d.range(0.1f, 0.34f)),
                  h = std::min(height, w * d.range(0.6f, 1.3f));
      Builder p = b.in(tilted_x(-0.25f, {0, 0, -0.03f}));
      p.box({-w / 2, 0, -0.01f}, {w / 2, h, 0}, set.style.dark, 0.003f);
      p.picture({-w * 0.45f, h * 0.06f, 0.001f}, {w * 0.9f, 0, 0}, {0, h * 0.88f, 0},
                poster_material(set, d, 48));
      if (depth > 0.25f && d.chance(0.5f))
        b.box({-w / 2, 0, -0.03f}, {w / 2, 0.015f, 0.2f}, set.style.dark, 0.003f);
    }
  }
}

void strew(Set& set, Dice& d, const Top& top, float fill) {
  const float cell = d.range(0.16f, 0.35f);
  const int nx = std::max(1, static_cast<int>(top.width / cell)),
            nz = std::max(1, static_cast<int>(top.depth / cell));
  const float w = top.width / static_cast<float>(nx), l = top.depth / static_cast<float>(nz);
  if (w < 0.05f || l < 0.05f || top.room < 0.05f) return;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < nz; ++j) {
      if (!d.chance(fill)) continue;
      const float x = -top.width / 2 + w * (static_cast<float>(i) + d.range(0.35f, 0.65f));
      const float z = -top.depth / 2 + l * (static_cast<float>(j) + d.range(0.35f, 0.65f));
      const float turn = d.chance(0.6f) ? d.range(-0.3f, 0.3f) : d.range(-3, 3);
      const Frame f = top.frame * turned(turn, {x, 0, z});
      if (wants_model(set, d) && model_clutter(set, d, f, w, l, top.room)) continue;
      clutter(set, d, set.solid(f), w * 0.8f, l * 0.8f, top.room);
    }
  }
}

}  // namespace ps::rooms
