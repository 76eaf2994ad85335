// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/pieces.h"

namespace ps::rooms {

Piece partition(Set& set, Dice& d, float height) {
  const float w = d.range(1, 3), high = d.chance(0.4f) ? height - 0.002f : d.range(1.1f, 2);
  const int frame = d.chance(0.5f) ? set.style.metal : set.add(surface(d));
  const int panel = set.add(d.chance(0.5f) ? cloth(d) : surface(d));
  const float solid = d.chance(0.5f) ? high : d.range(0, high * 0.6f);
  const int fields = std::max(1, static_cast<int>(w / d.range(0.6f, 1.2f)));
  return {{w, high, 0.08f}, [=](Set&, Builder b) {
            for (int i = 0; i <= fields; ++i) {
              const float x = w * (static_cast<float>(i) / static_cast<float>(fields) - 0.5f);
              b.box({x - 0.025f, 0, -0.03f}, {x + 0.025f, high, 0.03f}, frame, 0.004f);
            }
            b.box({-w / 2, high - 0.05f, -0.03f}, {w / 2, high, 0.03f}, frame, 0.004f);
            b.box({-w / 2, 0, -0.03f}, {w / 2, 0.06f, 0.03f}, frame, 0.004f);
            if (solid > 0.1f) b.box({-w / 2, 0.05f, -0.02f}, {w / 2, solid, 0.02f}, panel);
          }};
}

Piece stairs(Set& set, Dice& d, float height) {
  const int steps = d.whole(4, 15);
  const float rise = std::min(0.18f, (height - 0.1f) / static_cast<float>(steps)),
              tread = d.range(0.24f, 0.3f);
  const float width = d.range(0.8f, 1.3f), length = tread * static_cast<float>(steps);
  const int body = set.add(surface(d)), rail = set.style.metal;
  const bool open = d.chance(0.4f), railing = d.chance(0.8f);
  const float top = rise * static_cast<float>(steps);
  return {{length, std::min(height - 0.01f, top + 0.9f), width}, [=](Set&, Builder b) {
            const float z = width / 2, x0 = -length / 2;
            for (int i = 0; i < steps; ++i) {
              const float x = x0 + tread * static_cast<float>(i),
                          y = rise * static_cast<float>(i + 1);
              b.box({x, open ? y - 0.05f : 0, -z}, {x + tread + 0.02f, y, z}, body, 0.004f);
            }
            for (int i = 0; railing && i < steps; ++i) {
              const float x = x0 + tread * (static_cast<float>(i) + 0.5f),
                          y = rise * static_cast<float>(i + 1);
              const float up = std::min(0.9f, height - y - 0.05f);
              b.rod({x, y, z - 0.04f}, {x, y + up, z - 0.04f}, 0.01f, rail, 5);
              if (i > 0)
                b.rod({x - tread, y - rise + up, z - 0.04f}, {x, y + up, z - 0.04f}, 0.02f, rail);
            }
          }};
}

Piece piano(Set& set, Dice& d) {
  const int body =
      set.add(d.chance(0.6f) ? plain(srgb(0.05f, 0.05f, 0.06f), 0.05f) : wood_material(d));
  return {{1.45f, 1.2f, 0.6f}, [=](Set& s, Builder b) {
            b.box({-0.72f, 0.1f, -0.3f}, {0.72f, 1.2f, 0.02f}, body, 0.01f);
            b.box({-0.72f, 0.58f, 0.02f}, {0.72f, 0.68f, 0.3f}, body, 0.01f);
            b.box({-0.65f, 0.68f, 0.06f}, {0.65f, 0.7f, 0.24f}, s.style.white);
            for (int i = 0; i < 30; ++i) {
              if (i % 7 == 2 || i % 7 == 6) continue;
              const float x = -0.63f + 0.042f * static_cast<float>(i);
              b.box({x, 0.7f, 0.06f}, {x + 0.018f, 0.71f, 0.16f}, s.style.dark);
            }
            for (const float x : {-0.7f, 0.66f})
              b.box({x, 0, 0.2f}, {x + 0.05f, 0.6f, 0.28f}, body);
          }};
}

/// Table football or the like: a tub on legs, with rods across.
Piece table_game(Set& set, Dice& d) {
  const int body = set.add(surface(d)),
            field = set.add(plain(hsv(d.range(0.25f, 0.4f), 0.6f, 0.5f)));
  const int red = set.add(plain(hsv(0, 0.8f, 0.7f))), blue = set.add(plain(hsv(0.62f, 0.8f, 0.7f)));
  return {{1.45f, 0.95f, 0.95f}, [=](Set& s, Builder b) {
            for (const float x : {-1.f, 1.f}) {
              b.box({x * 0.7f - 0.02f, 0.65f, -0.38f}, {x * 0.7f + 0.02f, 0.9f, 0.38f}, body);
              b.box({-0.72f, 0.65f, x * 0.37f - 0.02f}, {0.72f, 0.9f, x * 0.37f + 0.02f}, body);
              for (const float z : {-1.f, 1.f}) {
                b.rod({x * 0.68f, 0, z * 0.4f}, {x * 0.6f, 0.66f, z * 0.32f}, 0.04f, s.style.dark);
              }
            }
            b.box({-0.7f, 0.68f, -0.36f}, {0.7f, 0.76f, 0.36f}, field);
            for (int i = 0; i < 8; ++i) {
              const float x = -0.6f + 0.171f * static_cast<float>(i),
                          side = i % 2 == 0 ? 1.f : -1.f;
              b.rod({x, 0.86f, -0.62f * side}, {x, 0.86f, 0.5f * side}, 0.008f, s.style.metal);
              b.rod({x, 0.86f, -0.62f * side}, {x, 0.86f, -0.5f * side}, 0.017f, s.style.dark);
              for (int j = -1; j <= 1; ++j) {
                const float z = 0.2f * static_cast<float>(j);
                b.box({x - 0.012f, 0.78f, z - 0.015f}, {x + 0.012f, 0.89f, z + 0.015f},
                      i % 2 == 0 ? red : blue, 0.005f);
              }
            }
          }};
}

Piece easel(Set& set, Dice& d) {
  const int legs = d.chance(0.5f) ? set.style.metal : set.add(wood_material(d)),
            sheet = poster_material(set, d, 96);
  const float w = d.range(0.6f, 0.9f), high = d.range(1.6f, 1.9f);
  return {
      {w, high, 0.7f}, [=](Set& s, Builder b) {
        for (const float x : {-1.f, 1.f})
          b.rod({x * w * 0.45f, 0, 0.3f}, {x * 0.1f, high, -0.1f}, 0.015f, legs);
        b.rod({0, 0, -0.33f}, {0, high, -0.1f}, 0.015f, legs);
        Builder board = b.in(tilted_x(-0.23f, {0, 0.7f, 0.13f}));
        board.box({-w / 2, 0, -0.015f}, {w / 2, high - 0.75f, 0.01f}, s.style.white, 0.003f);
        board.picture({-w * 0.47f, 0.02f, 0.011f}, {w * 0.94f, 0, 0}, {0, high - 0.8f, 0}, sheet);
      }};
}

Piece locker_row(Set& set, Dice& d) {
  const int columns = d.whole(2, 6), rows = d.whole(1, 4);
  const float cell = d.range(0.28f, 0.4f), high = d.range(1.2f, 2),
              w = cell * static_cast<float>(columns);
  const int body = set.add(surface(d));
  int fronts[3];
  for (int& f : fronts) f = d.chance(0.5f) ? body : set.add(plain(any_color(d), 0.02f));
  Dice own = d.child();
  const std::array<int, 3> colors = {fronts[0], fronts[1], fronts[2]};
  return {{w, high, 0.5f}, [=](Set& s, Builder b) mutable {
            b.box({-w / 2, 0, -0.25f}, {w / 2, high, 0.235f}, body);
            const float h = (high - 0.1f) / static_cast<float>(rows);
            for (int i = 0; i < columns; ++i) {
              for (int j = 0; j < rows; ++j) {
                const float x = -w / 2 + cell * static_cast<float>(i),
                            y = 0.08f + h * static_cast<float>(j);
                b.box({x + 0.005f, y, 0.235f}, {x + cell - 0.005f, y + h - 0.008f, 0.25f},
                      colors[own.below(3)], 0.003f);
                b.box({x + cell - 0.06f, y + h * 0.5f, 0.25f},
                      {x + cell - 0.035f, y + h * 0.5f + 0.06f, 0.262f}, s.style.metal);
              }
            }
          }};
}

}  // namespace ps::rooms
