// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/pieces.h"

namespace ps::rooms {
namespace {

void four_legs(Builder b, float x, float z, float height, float radius, float splay, bool round,
               int material) {
  for (const float sx : {-1.f, 1.f}) {
    for (const float sz : {-1.f, 1.f}) {
      const Vec top{sx * x, height, sz * z};
      if (round) {
        b.rod(top + Vec{sx * splay, -height, sz * splay}, top, radius, material);
      } else {
        b.box(top - Vec{radius, height, radius}, top + Vec{radius, 0, radius}, material, 0.003f);
      }
    }
  }
}

/// Steel tube bent to a C: the seat hangs in front of it.
void cantilever(Builder b, float x, float z, float seat, int material) {
  for (const float s : {-1.f, 1.f}) {
    b.rod({s * x, seat, z}, {s * x, 0.015f, z}, 0.012f, material);
    b.rod({s * x, 0.015f, z}, {s * x, 0.015f, -z}, 0.012f, material);
    b.rod({s * x, seat, z}, {s * x, seat, -z}, 0.012f, material);
  }
  b.rod({-x, 0.015f, -z}, {x, 0.015f, -z}, 0.012f, material);
}

void star_foot(Builder b, float radius, float height, int arms, bool castors, int material,
               int dark) {
  for (int i = 0; i < arms; ++i) {
    const float a = 6.2831853f * static_cast<float>(i) / static_cast<float>(arms) + 0.3f;
    const Vec end{radius * std::cos(a), castors ? 0.07f : 0.02f, radius * std::sin(a)};
    b.rod({0, 0.1f, 0}, end, 0.018f, material);
    if (castors) b.ball({end.x, 0.028f, end.z}, 0.028f, dark, 5);
  }
  b.rod({0, 0.06f, 0}, {0, height, 0}, 0.025f, material, 8);
}

}  // namespace

Piece chair(Set& set, Dice& d) {
  const float w = d.range(0.38f, 0.5f), depth = d.range(0.4f, 0.52f), seat = d.range(0.42f, 0.48f);
  const float top = d.range(0.75f, 1.05f);
  const int body = set.add(surface(d)), cover = d.chance(0.5f) ? body : set.add(cloth(d));
  const int legs = d.chance(0.5f) ? body : set.style.metal;
  const int foot = d.below(4), back = d.below(4);
  const bool arms = d.chance(0.2f);
  const float lean = d.range(0.02f, 0.1f);
  return {
      {w, top, depth}, [=](Set&, Builder b) {
        const float x = w / 2 - 0.03f, z = depth / 2 - 0.03f;
        if (foot == 0) {
          cantilever(b, x, z, seat, legs);
        } else if (foot == 1) {
          star_foot(b, 0.27f, seat, 4, false, legs, legs);
        } else {
          four_legs(b, x, z, seat, foot == 2 ? 0.012f : 0.018f, foot == 2 ? 0.03f : 0, foot == 2,
                    legs);
        }
        if (cover == body) {
          b.box({-w / 2, seat, -depth / 2}, {w / 2, seat + 0.025f, depth / 2}, body, 0.01f);
        } else {
          b.cushion({-w / 2, seat, -depth / 2}, {w / 2, seat + 0.07f, depth / 2}, cover, 0.3f, 6);
        }
        Builder r = b.in(tilted_x(-lean * 2, {0, seat, -depth / 2 + 0.03f}));
        const float high = top - seat;
        for (const float s : {-1.f, 1.f})
          r.rod({s * x, 0, 0}, {s * x, high * 0.95f, 0}, 0.012f, legs);
        if (back == 0) {
          r.box({-w / 2, high * 0.5f, -0.012f}, {w / 2, high, 0.012f}, body, 0.008f);
        } else if (back == 1) {
          r.box({-w / 2, 0.06f, -0.02f}, {w / 2, high, 0.02f}, cover, 0.015f);
        } else if (back == 2) {
          for (int i = 0; i < 4; ++i) {
            const float u = (static_cast<float>(i) - 1.5f) * w * 0.22f;
            r.box({u - 0.012f, 0, -0.006f}, {u + 0.012f, high - 0.03f, 0.006f}, body);
          }
          r.box({-w / 2, high - 0.06f, -0.012f}, {w / 2, high, 0.012f}, body, 0.005f);
        } else {
          for (int i = 1; i < 4; ++i) {
            const float y = high * static_cast<float>(i) / 3.4f;
            r.box({-x, y, -0.008f}, {x, y + 0.05f, 0.008f}, body, 0.004f);
          }
        }
        if (arms) {
          for (const float s : {-1.f, 1.f}) {
            b.rod({s * x, seat, z}, {s * x, seat + 0.2f, z}, 0.012f, legs);
            b.box({s * x - 0.02f, seat + 0.2f, -depth / 2},
                  {s * x + 0.02f, seat + 0.225f, depth / 2}, body, 0.008f);
          }
        }
      }};
}

Piece office_chair(Set& set, Dice& d) {
  const float seat = d.range(0.42f, 0.55f), top = seat + d.range(0.4f, 0.75f),
              w = d.range(0.44f, 0.52f);
  const int cover = set.add(cloth(d)), foot = d.chance(0.5f) ? set.style.metal : set.style.dark;
  const int dark = set.style.dark;
  const bool arms = d.chance(0.7f);
  const float turn = d.range(-0.6f, 0.6f);
  return {{0.62f, top, 0.62f}, [=](Set&, Builder base) {
            star_foot(base, 0.3f, seat, 5, true, foot, dark);
            Builder b = base.in(turned(turn));
            b.cushion({-w / 2, seat, -0.23f}, {w / 2, seat + 0.1f, 0.25f}, cover, 0.35f, 7);
            b.rod({0, seat, -0.2f}, {0, seat + 0.25f, -0.27f}, 0.025f, dark);
            Builder r = b.in(tilted_x(-0.15f, {0, seat + 0.15f, -0.22f}));
            r.cushion({-w / 2, 0, -0.04f}, {w / 2, top - seat - 0.15f, 0.04f}, cover, 0.3f, 7);
            for (const float s : {-1.f, 1.f}) {
              if (!arms) break;
              b.rod({s * 0.2f, seat + 0.03f, 0}, {s * 0.29f, seat + 0.2f, 0}, 0.015f, dark);
              b.box({s * 0.29f - 0.035f, seat + 0.2f, -0.12f},
                    {s * 0.29f + 0.035f, seat + 0.23f, 0.13f}, dark, 0.012f);
            }
          }};
}

Piece stool(Set& set, Dice& d) {
  const float high = d.chance(0.6f) ? d.range(0.42f, 0.5f) : d.range(0.6f, 0.8f),
              r = d.range(0.15f, 0.22f);
  const int seat = d.chance(0.5f) ? set.add(surface(d)) : set.add(cloth(d));
  const int legs = d.chance(0.5f) ? set.style.metal : seat;
  const bool star = d.chance(0.3f);
  return {{2 * r, high, 2 * r}, [=](Set&, Builder b) {
            if (star) {
              b.cylinder({0, 0, 0}, r * 0.9f, 0.02f, legs);
              b.rod({0, 0, 0}, {0, high, 0}, 0.025f, legs, 8);
            } else {
              four_legs(b, r * 0.6f, r * 0.6f, high, 0.013f, 0.04f, true, legs);
            }
            b.cylinder({0, high - 0.05f, 0}, r, 0.05f, seat);
          }};
}

Piece sofa(Set& set, Dice& d, bool single) {
  const float w = single ? d.range(0.7f, 1) : d.range(1.4f, 2.6f), depth = d.range(0.75f, 1);
  const float seat = d.range(0.36f, 0.46f), top = d.range(0.65f, 0.95f),
              arm = d.range(0.06f, 0.22f);
  const float arm_top = d.range(0.5f, top);
  const int cover = set.add(cloth(d)), extra = set.add(cloth(d)), legs = set.style.dark;
  const int seats = single ? 1 : std::max(2, static_cast<int>(w / 0.75f));
  const float soft = d.range(0.15f, 0.45f);
  const bool round = d.chance(0.4f);
  const int pillows = d.below(single ? 2 : 4);
  Dice own = d.child();
  return {
      {w, top, depth}, [=](Set&, Builder b) mutable {
        const float x = w / 2, z = depth / 2;
        b.box({-x + 0.02f, 0.08f, -z + 0.02f}, {x - 0.02f, seat - 0.12f, z - 0.02f}, cover, 0.02f);
        for (const float s : {-1.f, 1.f}) {
          for (const float t : {-1.f, 1.f})
            b.rod({s * (x - 0.08f), 0, t * (z - 0.08f)}, {s * (x - 0.08f), 0.09f, t * (z - 0.08f)},
                  0.02f, legs);
          const Vec low{s > 0 ? x - arm : -x, 0.07f, -z}, high{s > 0 ? x : -x + arm, arm_top, z};
          if (round) {
            b.cushion(low, high, cover, 0.25f, 8);
          } else {
            b.box(low, high, cover, 0.03f);
          }
        }
        const float inner = w - 2 * arm, back = 0.2f;
        b.box({-x + arm, 0.1f, -z}, {x - arm, top - 0.05f, -z + back}, cover, 0.04f);
        for (int i = 0; i < seats; ++i) {
          const float u0 = -inner / 2 + inner * static_cast<float>(i) / static_cast<float>(seats);
          const float u1 = u0 + inner / static_cast<float>(seats);
          b.cushion({u0, seat - 0.15f, -z + back - 0.02f}, {u1, seat + 0.03f, z}, cover,
                    soft * 0.6f, 8);
          b.in(tilted_x(-0.15f, {0, seat, -z + back}))
              .cushion({u0, 0, -0.06f}, {u1, top - seat, 0.12f}, cover, soft, 8);
        }
        for (int i = 0; i < pillows; ++i) {
          const float u = own.range(-inner / 2 + 0.2f, inner / 2 - 0.2f);
          Builder p = b.in(turned(own.range(-0.5f, 0.5f), {u, seat + 0.02f, -z + back + 0.2f}) *
                           tilted_x(-0.35f));
          p.cushion({-0.22f, 0, -0.07f}, {0.22f, 0.4f, 0.07f}, extra, 0.5f, 7);
        }
      }};
}

Piece bed(Set& set, Dice& d) {
  const float w = d.pick({0.9f, 1.2f, 1.4f, 1.6f, 1.8f}), depth = d.range(1.95f, 2.15f),
              high = d.range(0.3f, 0.6f);
  const float head = d.range(0.6f, 1.2f);
  const int frame = set.add(surface(d)), sheet = set.add(cloth(d)), cover = set.add(cloth(d));
  const float folded = d.range(0, 0.5f);
  Dice own = d.child();
  return {{w, head, depth}, [=](Set&, Builder b) mutable {
            const float x = w / 2, z = depth / 2;
            b.box({-x, 0.12f, -z}, {x, high * 0.7f, z}, frame, 0.01f);
            for (const float s : {-1.f, 1.f}) {
              for (const float t : {-1.f, 1.f}) {
                b.box({s * (x - 0.04f) - 0.03f, 0, t * (z - 0.04f) - 0.03f},
                      {s * (x - 0.04f) + 0.03f, 0.13f, t * (z - 0.04f) + 0.03f}, frame);
              }
            }
            b.box({-x, 0.1f, -z - 0.02f}, {x, head, -z + 0.03f}, frame, 0.01f);
            b.cushion({-x + 0.02f, high * 0.6f, -z + 0.03f}, {x - 0.02f, high + 0.08f, z - 0.01f},
                      sheet, 0.12f, 8);
            const float from = -z + mix(0.5f, depth * 0.7f, folded);
            b.cushion({-x - 0.03f, high * 0.45f, from}, {x + 0.03f, high + 0.16f, z + 0.02f}, cover,
                      0.2f, 12);
            const int pillows = w > 1.3f ? 2 : 1;
            for (int i = 0; i < pillows; ++i) {
              const float u = pillows == 1 ? 0 : (static_cast<float>(i) - 0.5f) * w * 0.48f;
              Builder p = b.in(turned(own.range(-0.3f, 0.3f), {u, high + 0.06f, -z + 0.3f}) *
                               tilted_x(-0.2f));
              p.cushion({-0.33f, 0, -0.22f}, {0.33f, 0.16f, 0.22f},
                        own.chance(0.5f) ? sheet : cover, 0.55f, 8);
            }
          }};
}

}  // namespace ps::rooms
