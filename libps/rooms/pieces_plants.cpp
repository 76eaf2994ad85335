// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/pieces.h"

namespace ps::rooms {
namespace {

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

}  // namespace

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

Piece plant(Set& set, Dice& d) {
  const float high = d.range(0.5f, 2), r = high * d.range(0.2f, 0.4f);
  const int pot = set.add(surface(d)), soil = set.add(plain(srgb(0.2f, 0.15f, 0.1f))),
            leaf = green(set, d);
  const int stem = set.add(plain(srgb(0.35f, 0.28f, 0.18f)));
  Dice own = d.child();
  return {{1.2f * r, high, 1.2f * r},
          [=](Set&, Builder b) mutable { draw_plant(own, b, high, r, pot, soil, leaf, stem); }};
}

}  // namespace ps::rooms
