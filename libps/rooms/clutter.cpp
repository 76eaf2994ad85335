// SPDX-License-Identifier: BSD-3-Clause
// What lies about.
#include "libps/rooms/pieces.h"

namespace ps::rooms {
namespace {

/// One thing that stands on a table or shelf.
class Clutter {
 public:
  Clutter(Set& set, Dice& d, const Builder& b, float width, float depth, float height)
      : set_(set),
        d_(d),
        b_(b),
        width_(width),
        depth_(depth),
        height_(height),
        r_(0.5f * std::min(width, depth)) {}

  void draw() {
    static void (Clutter::*const kinds[])() = {&Clutter::bottle, &Clutter::mug,   &Clutter::bowl,
                                               &Clutter::books,  &Clutter::books, &Clutter::paper,
                                               &Clutter::box,    &Clutter::vase,  &Clutter::basket,
                                               &Clutter::rag,    &Clutter::stand};
    (this->*kinds[d_.below(11)])();
  }

 private:
  int color(float gloss = 0) { return set_.add(plain(any_color(d_), gloss)); }

  void bottle() {
    const float h = std::min(height_, d_.range(0.18f, 0.33f)),
                k = std::min(r_, d_.range(0.03f, 0.045f));
    b_.lathe({}, {{0, 0}, {k, 0}, {k, h * 0.6f}, {k * 0.35f, h * 0.75f}, {k * 0.35f, h}, {0, h}},
             color(0.05f), 12);
  }

  void mug() {
    const float h = std::min(height_, d_.range(0.08f, 0.12f)),
                k = std::min(r_, d_.range(0.03f, 0.05f));
    const int m = color(0.04f);
    b_.lathe({}, {{0, 0}, {k, 0}, {k, h}, {k * 0.9f, h}, {k * 0.85f, 0.01f}}, m, 12);
    b_.rod({k, h * 0.25f, 0}, {k * 1.6f, h * 0.5f, 0}, 0.006f, m, 5);
    b_.rod({k * 1.6f, h * 0.5f, 0}, {k, h * 0.8f, 0}, 0.006f, m, 5);
  }

  /// Perhaps with fruit.
  void bowl() {
    const float k = std::min(r_, d_.range(0.08f, 0.16f)), h = std::min(height_, k * 0.6f);
    b_.lathe({},
             {{k * 0.4f, 0},
              {k * 0.8f, h * 0.4f},
              {k, h},
              {k * 0.95f, h},
              {k * 0.7f, h * 0.4f},
              {0, h * 0.2f}},
             color(0.03f), 16);
    const int fruit = d_.below(6),
              skin = set_.add(
                  plain(hsv(d_.range(0, 0.3f), d_.range(0.6f, 0.9f), d_.range(0.5f, 0.9f)), 0.02f));
    for (int i = 0; i < fruit; ++i) {
      const float a = d_.range(0, 6.28f);
      b_.ball({k * 0.45f * std::cos(a), h * 0.7f + 0.01f * static_cast<float>(i),
               k * 0.45f * std::sin(a)},
              0.035f, skin, 6);
    }
  }

  /// Lying flat.
  void books() {
    float y = 0;
    const int count = d_.whole(1, 5);
    for (int i = 0; i < count; ++i) {
      const float t = d_.range(0.01f, 0.04f), w = std::min(width_, d_.range(0.13f, 0.24f)) / 2,
                  l = std::min(depth_, d_.range(0.18f, 0.3f)) / 2;
      if (y + t > height_) break;
      Builder p = b_.in(turned(d_.range(-0.3f, 0.3f), {0, y, 0}));
      p.box({-w, 0, -l}, {w, t, l}, color());
      y += t;
    }
  }

  void paper() {
    if (width_ > 0.25f && depth_ > 0.3f) paper_sheets();
  }

  void box() {
    const float w = std::min(width_, d_.range(0.06f, 0.4f)) / 2,
                l = std::min(depth_, d_.range(0.05f, 0.3f)) / 2,
                h = std::min(height_, d_.range(0.04f, 0.3f));
    b_.box({-w, 0, -l}, {w, h, l}, color(), 0.003f);
    if (d_.chance(0.5f))
      b_.picture({-w, 0, l + 0.001f}, {2 * w, 0, 0}, {0, h, 0}, poster_material(set_, d_, 32));
  }

  /// A small plant.
  void vase() {
    if (height_ < 0.18f) return;
    const float h = std::min(height_, d_.range(0.18f, 0.5f));
    draw_plant(d_, b_, h, std::min(r_ * 1.3f, h * 0.5f), color(0.03f), set_.style.dark,
               green(set_, d_), set_.style.dark);
  }

  /// With things in it, or a crate.
  void basket() {
    const float w = std::min(width_, d_.range(0.2f, 0.45f)) / 2,
                l = std::min(depth_, d_.range(0.15f, 0.35f)) / 2,
                h = std::min(height_, d_.range(0.08f, 0.25f));
    const int m = set_.add(cloth(d_));
    b_.box({-w, 0, -l}, {w, 0.01f, l}, m);
    b_.box({-w, 0, -l}, {-w + 0.012f, h, l}, m);
    b_.box({w - 0.012f, 0, -l}, {w, h, l}, m);
    b_.box({-w, 0, -l}, {w, h, -l + 0.012f}, m);
    b_.box({-w, 0, l - 0.012f}, {w, h, l}, m);
    const int inside = d_.below(5);
    for (int i = 0; i < inside; ++i) {
      const float k = std::min(0.06f, h * 0.6f);
      b_.ball({d_.range(-w + k, w - k) * 0.9f, k + 0.02f * static_cast<float>(i),
               d_.range(-l + k, l - k) * 0.9f},
              k, color(), 6);
    }
  }

  /// Cloth, thrown down.
  void rag() {
    const float w = std::min(width_, d_.range(0.15f, 0.5f)) / 2,
                l = std::min(depth_, d_.range(0.15f, 0.4f)) / 2;
    b_.cushion({-w, -0.03f, -l}, {w, std::min(height_, d_.range(0.03f, 0.15f)), l},
               set_.add(cloth(d_)), d_.range(0.5f, 1), 8);
  }

  /// A picture on a stand, or a laptop.
  void stand() {
    const float w = std::min(width_, d_.range(0.1f, 0.34f)),
                h = std::min(height_, w * d_.range(0.6f, 1.3f));
    Builder p = b_.in(tilted_x(-0.25f, {0, 0, -0.03f}));
    p.box({-w / 2, 0, -0.01f}, {w / 2, h, 0}, set_.style.dark, 0.003f);
    p.picture({-w * 0.45f, h * 0.06f, 0.001f}, {w * 0.9f, 0, 0}, {0, h * 0.88f, 0},
              poster_material(set_, d_, 48));
    if (depth_ > 0.25f && d_.chance(0.5f))
      b_.box({-w / 2, 0, -0.03f}, {w / 2, 0.015f, 0.2f}, set_.style.dark, 0.003f);
  }

  void paper_sheets() {
    Material m = plain(srgb(0.93f, 0.93f, 0.9f));
    m.pattern = Pattern::text;
    m.second = srgb(0.2f, 0.2f, 0.25f);
    m.scale = d_.range(0.02f, 0.06f);
    m.seed = d_.bits();
    const int page = d_.chance(0.7f) ? set_.add(m) : poster_material(set_, d_, 48);
    const int sheets = d_.whole(1, 4);
    for (int i = 0; i < sheets; ++i) {
      Builder p = b_.in(turned(d_.range(-0.6f, 0.6f),
                               {d_.range(-0.05f, 0.05f), 0.002f + 0.002f * static_cast<float>(i),
                                d_.range(-0.05f, 0.05f)}));
      p.picture({-0.105f, 0, 0.148f}, {0.21f, 0, 0}, {0, 0, -0.297f}, page);
    }
  }

  Set& set_;
  Dice& d_;
  Builder b_;
  float width_, depth_, height_;
  float r_;  ///< of what is round
};

}  // namespace

void clutter(Set& set, Dice& d, Builder b, float width, float depth, float height) {
  Clutter(set, d, b, width, depth, height).draw();
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
