// SPDX-License-Identifier: BSD-3-Clause
// What hangs on walls: the origin is the middle of its lower edge, on the wall.
#include "libps/rooms/pieces.h"

namespace ps::rooms {

Piece wall_picture(Set& set, Dice& d) {
  const float w = d.range(0.2f, 1.3f), h = w * d.range(0.6f, 1.5f);
  const int m = poster_material(set, d, 128), rim = set.add(surface(d));
  const bool framed = d.chance(0.6f);
  const float edge = d.range(0.01f, 0.05f);
  return {{w, h, 0.03f}, [=](Set&, Builder b) {
            float z = 0.004f;
            if (framed) {
              b.box({-w / 2, 0, 0}, {w / 2, edge, 0.025f}, rim);
              b.box({-w / 2, h - edge, 0}, {w / 2, h, 0.025f}, rim);
              b.box({-w / 2, 0, 0}, {-w / 2 + edge, h, 0.025f}, rim);
              b.box({w / 2 - edge, 0, 0}, {w / 2, h, 0.025f}, rim);
              z = 0.012f;
            }
            b.picture({-w / 2, 0, z}, {w, 0, 0}, {0, h, 0}, m);
          }};
}

Piece wall_board(Set& set, Dice& d) {
  const float w = d.range(0.9f, 2.4f), h = d.range(0.7f, 1.3f);
  const bool white = d.chance(0.6f);
  const int m = set.add(plain(
      white ? srgb(0.92f, 0.93f, 0.93f) : hsv(d.range(0.05f, 0.4f), 0.4f, d.range(0.25f, 0.65f)),
      white ? 0.04f : 0));
  const int rim = set.style.metal, notes = white ? d.below(3) : d.below(14);
  Dice own = d.child();
  return {{w, h, 0.06f}, [=](Set& s, Builder b) mutable {
            b.box({-w / 2, 0, 0}, {w / 2, h, 0.015f}, m);
            b.box({-w / 2, -0.01f, 0}, {w / 2, 0.01f, 0.06f}, rim);
            b.box({-w / 2, h - 0.015f, 0}, {w / 2, h, 0.022f}, rim);
            for (int i = 0; i < notes; ++i) {
              const float size = own.range(0.07f, 0.25f);
              b.picture({own.range(-w / 2, w / 2 - size), own.range(0.05f, h - size),
                         0.017f + 0.001f * static_cast<float>(i)},
                        {size, 0, 0}, {0, size, 0}, poster_material(s, own, 32));
            }
          }};
}

Piece wall_screen(Set& set, Dice& d) {
  const float w = d.range(0.7f, 1.6f), h = w * 0.57f;
  const int dark = set.style.dark;
  int m = set.add(plain(srgb(0.05f, 0.05f, 0.06f), 0.06f));
  if (d.chance(0.35f)) {
    Material on = plain({0.5f, 0.5f, 0.5f}, 0.05f);
    on.pattern = Pattern::picture;
    on.picture = set.add(poster(d, 128, 72));
    on.emission = Vec{1, 1, 1} * d.range(0.2f, 0.8f);
    m = set.add(on);
  }
  return {{w, h, 0.06f}, [=](Set&, Builder b) {
            b.box({-w / 2, 0, 0.01f}, {w / 2, h, 0.055f}, dark, 0.006f);
            b.picture({-w / 2 + 0.015f, 0.02f, 0.0555f}, {w - 0.03f, 0, 0}, {0, h - 0.035f, 0}, m);
          }};
}

Piece wall_shelf(Set& set, Dice& d) {
  const float w = d.range(0.5f, 1.6f), depth = d.range(0.15f, 0.3f);
  const int m = set.add(surface(d));
  const float fill = d.unit();
  Dice own = d.child();
  return {{w, 0.4f, depth}, [=](Set& s, Builder b) mutable {
            b.box({-w / 2, 0, 0}, {w / 2, 0.025f, depth}, m, 0.003f);
            strew(s, own,
                  {b.frame() * Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0.025f, depth / 2}}, w,
                   depth, 0.35f},
                  fill);
          }};
}

Piece wall_mirror(Set& set, Dice& d) {
  const float w = d.range(0.4f, 1.2f), h = d.range(0.5f, 1.6f);
  Material glass = plain(srgb(0.6f, 0.63f, 0.64f), 0.3f);
  if (set.options.mirrors) glass.gloss = 1;
  glass.roughness = 0;
  const int m = set.add(glass), rim = set.add(surface(d));
  return {{w, h, 0.03f}, [=](Set&, Builder b) {
            b.box({-w / 2, 0, 0}, {w / 2, h, 0.015f}, rim, 0.004f);
            b.picture({-w / 2 + 0.02f, 0.02f, 0.016f}, {w - 0.04f, 0, 0}, {0, h - 0.04f, 0}, m);
          }};
}

Piece wall_clock(Set& set, Dice& d) {
  const float r = d.range(0.1f, 0.2f);
  const int face = set.add(plain(paint(d))), rim = set.add(plain(any_color(d))),
            dark = set.style.dark;
  const float a = d.range(0, 6), c = d.range(0, 6);
  return {{2 * r, 2 * r, 0.04f}, [=](Set&, Builder b) {
            Builder flat = b.in({{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, r, 0}});
            flat.cylinder({}, r, 0.03f, rim, -1, 20);
            flat.cylinder({0, 0.03f, 0}, r * 0.9f, 0.003f, face, -1, 20);
            flat.rod({0, 0.036f, 0}, {r * 0.7f * std::cos(a), 0.036f, r * 0.7f * std::sin(a)},
                     0.005f, dark, 4);
            flat.rod({0, 0.036f, 0}, {r * 0.45f * std::cos(c), 0.036f, r * 0.45f * std::sin(c)},
                     0.007f, dark, 4);
          }};
}

Piece coat_rack(Set& set, Dice& d) {
  const float w = d.range(0.5f, 1.4f);
  const int board = set.add(surface(d)), coats = d.below(5);
  Dice own = d.child();
  return {{w, 1.1f, 0.25f}, [=](Set& s, Builder b) mutable {
            b.box({-w / 2, 1, 0}, {w / 2, 1.1f, 0.02f}, board, 0.004f);
            for (float x = -w / 2 + 0.08f; x < w / 2; x += 0.18f)
              b.rod({x, 1.05f, 0.02f}, {x, 1.08f, 0.09f}, 0.008f, s.style.metal, 5);
            for (int i = 0; i < coats; ++i) {
              const float x = own.range(-w / 2 + 0.15f, w / 2 - 0.15f), low = own.range(0, 0.5f);
              b.cushion({x - 0.2f, low, 0.02f}, {x + 0.2f, 1.06f, own.range(0.12f, 0.25f)},
                        s.add(cloth(own)), 0.6f, 10);
            }
          }};
}

Piece wall_socket(Set& set, Dice& d) {
  const int m = d.chance(0.8f) ? set.style.white : set.style.dark, count = d.whole(1, 3);
  const float w = 0.08f * static_cast<float>(count);
  return {{w, 0.08f, 0.012f}, [=](Set&, Builder b) {
            b.box({-w / 2, 0, 0}, {w / 2, 0.08f, 0.012f}, m, 0.003f);
          }};
}

}  // namespace ps::rooms
