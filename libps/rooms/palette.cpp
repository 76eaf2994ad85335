// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "libps/rooms/set.h"

namespace ps::rooms {

Vec srgb(float r, float g, float b) {
  return linear_from_srgb(Vec{clamp01(r), clamp01(g), clamp01(b)});
}

Vec hsv(float hue, float saturation, float value) {
  const auto channel = [&](float shift) {
    const float k = std::fmod(shift + hue * 6, 6.f);
    return value - value * saturation * std::max(0.f, std::min(std::min(k, 4 - k), 1.f));
  };
  return srgb(channel(5), channel(3), channel(1));
}

float any_hue(Dice& d) {
  const float kind = d.unit();
  if (kind < 0.4f) return d.range(0.02f, 0.15f);
  if (kind < 0.65f) return d.range(0.53f, 0.66f);
  if (kind < 0.8f) return d.range(0.2f, 0.45f);
  if (kind < 0.9f) return d.range(0.97f, 1);
  return d.unit();
}

Vec paint(Dice& d) {
  const float kind = d.unit();
  if (kind < 0.45f) return hsv(d.range(0.05f, 0.2f), d.range(0, 0.05f), d.range(0.8f, 0.97f));
  if (kind < 0.6f) return hsv(d.range(0.08f, 0.15f), d.range(0.05f, 0.2f), d.range(0.7f, 0.93f));
  if (kind < 0.82f) return hsv(any_hue(d), d.range(0, 0.07f), d.range(0.25f, 0.8f));
  if (kind < 0.94f) return hsv(any_hue(d), d.range(0.08f, 0.3f), d.range(0.45f, 0.9f));
  return hsv(any_hue(d), d.range(0.3f, 0.7f), d.range(0.2f, 0.7f));
}

Vec any_color(Dice& d) {
  const float kind = d.unit();
  if (kind < 0.3f) return hsv(any_hue(d), d.range(0, 0.08f), d.range(0.7f, 0.95f));
  if (kind < 0.58f) return hsv(any_hue(d), d.range(0, 0.15f), d.range(0.08f, 0.35f));
  if (kind < 0.85f) return hsv(any_hue(d), d.range(0.15f, 0.5f), d.range(0.25f, 0.8f));
  return hsv(any_hue(d), d.range(0.5f, 0.9f), d.range(0.25f, 0.85f));
}

Material plain(Vec color, float gloss) {
  Material m;
  m.color = color;
  m.gloss = gloss;
  return m;
}

Material wall_material(Dice& d, Vec color) {
  Material m;
  m.color = color;
  m.second = color * d.range(0.6f, 0.9f);
  m.seed = d.bits();
  const float kind = d.unit();
  if (kind < 0.72f) {
    m.pattern = Pattern::plaster;
    m.scale = d.range(0.02f, 0.8f);
    m.amount = d.range(0.1f, 1.2f);
  } else if (kind < 0.8f) {
    m.pattern = Pattern::bricks;
    m.scale = d.range(0.2f, 0.3f);
    if (d.chance(0.5f))
      m.color = hsv(d.range(0.02f, 0.07f), d.range(0.3f, 0.6f), d.range(0.4f, 0.7f));
    m.second = m.color * d.range(0.5f, 1.5f);
    m.amount = d.range(0.3f, 1);
  } else if (kind < 0.87f) {
    m.pattern = Pattern::stripes;
    m.scale = d.range(0.04f, 0.3f);
    m.second = mix(m.color, any_color(d), d.range(0.1f, 0.5f));
  } else if (kind < 0.94f) {
    m.pattern = Pattern::blobs;
    m.scale = d.range(0.04f, 0.2f);
    m.second = mix(m.color, any_color(d), d.range(0.1f, 0.6f));
  } else {
    m = wood_material(d);
    m.pattern = Pattern::planks;
    m.scale = d.range(0.08f, 0.2f);
  }
  return m;
}

Material wood_material(Dice& d) {
  Material m;
  m.pattern = Pattern::wood;
  const float value = d.range(0.25f, 0.85f), hue = d.range(0.05f, 0.11f);
  m.color = hsv(hue, d.range(0.3f, 0.75f), value);
  m.second = m.color * d.range(0.4f, 0.75f);
  m.amount = d.range(0.4f, 1.3f);
  m.gloss = d.chance(0.5f) ? d.range(0.01f, 0.05f) : 0;
  m.roughness = d.range(0.02f, 0.25f);
  m.seed = d.bits();
  return m;
}

Material floor_material(Dice& d, RoomKind kind) {
  const bool wet = kind == RoomKind::bathroom || kind == RoomKind::kitchen;
  const bool plainer = kind == RoomKind::office || kind == RoomKind::corridor;
  Material m = wood_material(d);
  const float pick = d.unit();
  if (pick < (wet ? 0.2f : 0.45f)) {
    m.pattern = d.chance(0.8f) ? Pattern::planks : Pattern::herringbone;
    m.scale = d.range(0.07f, 0.22f);
    return m;
  }
  m.seed = d.bits();
  if (pick < (wet ? 0.8f : plainer ? 0.55f : 0.6f)) {
    m.pattern = d.chance(0.7f) ? Pattern::tiles : Pattern::marble;
    m.scale = m.pattern == Pattern::tiles ? d.range(0.1f, 0.6f) : d.range(0.4f, 1.5f);
    m.color =
        d.chance(0.7f) ? hsv(d.range(0, 0.2f), d.range(0, 0.25f), d.range(0.3f, 0.9f)) : paint(d);
    m.second = m.color * d.range(0.4f, 1.2f);
    m.gloss = d.chance(0.6f) ? d.range(0.02f, 0.08f) : 0;
  } else if (pick < 0.85f && !wet) {
    m.pattern = d.chance(0.5f) ? Pattern::carpet : Pattern::carpet_tiles;
    m.scale = 0.5f;
    m.color = d.chance(0.5f) ? hsv(any_hue(d), d.range(0, 0.15f), d.range(0.2f, 0.6f))
                             : hsv(any_hue(d), d.range(0.2f, 0.75f), d.range(0.2f, 0.6f));
    m.second = m.color * d.range(0.4f, 1.8f);
    m.amount = d.range(0.3f, 1);
    m.gloss = 0;
  } else {
    m.pattern = Pattern::speckle;
    m.scale = d.range(0.01f, 0.05f);
    m.color = hsv(any_hue(d), d.range(0, 0.3f), d.range(0.25f, 0.85f));
    m.second = m.color * d.range(0.5f, 1.4f);
    m.gloss = d.range(0, 0.05f);
  }
  return m;
}

Material cloth(Dice& d) {
  Material m;
  m.color = any_color(d);
  m.second = d.chance(0.6f) ? m.color * d.range(0.5f, 0.9f) : any_color(d);
  m.seed = d.bits();
  m.scale = d.range(0.004f, 0.02f);
  m.pattern = d.pick({Pattern::weave, Pattern::carpet, Pattern::plain, Pattern::weave});
  m.amount = d.range(0.3f, 1);
  if (d.chance(0.3f)) {
    m.pattern = d.pick({Pattern::stripes, Pattern::checks, Pattern::blobs, Pattern::grooves});
    m.scale = d.range(0.03f, 0.2f);
  }
  return m;
}

Material surface(Dice& d) {
  if (d.chance(0.5f)) return wood_material(d);
  Material m;
  m.color =
      d.chance(0.5f) ? hsv(d.range(0, 0.2f), d.range(0, 0.1f), d.range(0.6f, 0.95f)) : any_color(d);
  m.gloss = d.chance(0.4f) ? d.range(0.01f, 0.06f) : 0;
  m.roughness = d.range(0.02f, 0.3f);
  return m;
}

Material metal(Dice& d) {
  Material m;
  m.color = hsv(d.range(0, 0.15f), d.range(0, 0.1f), d.range(0.35f, 0.75f));
  m.gloss = d.range(0.1f, 0.6f);
  m.roughness = d.range(0.05f, 0.3f);
  return m;
}

namespace {

struct Canvas {
  Texture t;

  void fill(int x0, int y0, int x1, int y1, Vec a, Vec b) {
    for (int y = std::max(0, y0); y < std::min(t.height, y1); ++y) {
      const Vec c =
          mix(a, b, static_cast<float>(y - y0) / static_cast<float>(std::max(1, y1 - y0)));
      for (int x = std::max(0, x0); x < std::min(t.width, x1); ++x) set(x, y, c);
    }
  }
  void disc(float cx, float cy, float rx, float ry, Vec c) {
    for (int y = std::max(0, static_cast<int>(cy - ry)); y < std::min<float>(t.height, cy + ry);
         ++y) {
      for (int x = std::max(0, static_cast<int>(cx - rx)); x < std::min<float>(t.width, cx + rx);
           ++x) {
        const float a = (static_cast<float>(x) - cx) / rx, b = (static_cast<float>(y) - cy) / ry;
        if (a * a + b * b < 1) set(x, y, c);
      }
    }
  }
  void text(Dice& d, int x0, int y0, int x1, int y1, int size, Vec c) {
    for (int y = y0; y + size <= y1; y += size * 2) {
      const int end = x0 + static_cast<int>(static_cast<float>(x1 - x0) * d.range(0.5f, 1));
      for (int x = x0; x < end;) {
        const int word = size * d.whole(1, 5);
        fill(x, y, std::min(end, x + word), y + size, c, c);
        x += word + size;
      }
    }
  }
  void set(int x, int y, Vec c) {
    std::uint8_t* p = &t.rgb[(static_cast<std::size_t>(y) * t.width + x) * 3];
    p[0] = static_cast<std::uint8_t>(clamp01(c.x) * 255);
    p[1] = static_cast<std::uint8_t>(clamp01(c.y) * 255);
    p[2] = static_cast<std::uint8_t>(clamp01(c.z) * 255);
  }
};

Vec ink(Dice& d) {
  const Vec c = any_color(d);
  return {srgb_from_linear(c.x), srgb_from_linear(c.y), srgb_from_linear(c.z)};
}

/// Something like a photo: sky, ground, a few bodies.
void scenery(Dice& d, Canvas& c, int x0, int y0, int x1, int y1) {
  const int line = y0 + static_cast<int>(static_cast<float>(y1 - y0) * d.range(0.3f, 0.8f));
  c.fill(x0, y0, x1, line, ink(d), ink(d));
  c.fill(x0, line, x1, y1, ink(d) * 0.7f, ink(d) * 0.5f);
  const int bodies = d.whole(1, 8);
  for (int i = 0; i < bodies; ++i) {
    const float x = d.range(static_cast<float>(x0), static_cast<float>(x1));
    const float y = d.range(static_cast<float>(y0), static_cast<float>(y1));
    const float r = static_cast<float>(x1 - x0) * d.range(0.03f, 0.25f);
    const Vec body = ink(d);
    if (d.chance(0.6f)) {
      c.disc(x, y, r, r * d.range(0.5f, 2), body);
    } else {
      const int rx = static_cast<int>(r), ry = static_cast<int>(r * d.range(0.4f, 2.5f));
      c.fill(std::max(x0, static_cast<int>(x) - rx), std::max(y0, static_cast<int>(y) - ry),
             std::min(x1, static_cast<int>(x) + rx), std::min(y1, static_cast<int>(y) + ry), body,
             body * d.range(0.5f, 1.2f));
    }
  }
}

}  // namespace

Texture poster(Dice& d, int width, int height) {
  Canvas c{
      {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3)}};
  const Vec paper = d.chance(0.5f) ? Vec{0.95f, 0.94f, 0.9f} : ink(d);
  c.fill(0, 0, width, height, paper, d.chance(0.5f) ? paper : ink(d));
  const float kind = d.unit();
  if (kind < 0.4f) {
    const int border = d.chance(0.5f) ? width / 12 : 0;
    scenery(d, c, border, border, width - border, height - border);
  } else if (kind < 0.75f) {  // pictures and text in columns
    const int columns = d.whole(1, 3), rows = d.whole(1, 4);
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) {
        const int x0 = width * i / columns + 3, x1 = width * (i + 1) / columns - 3;
        const int y0 = height * j / rows + 3, y1 = height * (j + 1) / rows - 3;
        if (d.chance(0.5f)) {
          scenery(d, c, x0, y0, x1, y1);
        } else {
          c.text(d, x0, y0, x1, y1, d.whole(1, 4), ink(d) * 0.5f);
        }
      }
    }
  } else {  // abstract
    const int bodies = d.whole(3, 25);
    for (int i = 0; i < bodies; ++i) {
      c.disc(d.unit() * static_cast<float>(width), d.unit() * static_cast<float>(height),
             static_cast<float>(width) * d.range(0.02f, 0.4f),
             static_cast<float>(width) * d.range(0.02f, 0.4f), ink(d));
    }
  }
  if (d.chance(0.3f)) {
    c.text(d, width / 8, height / 12, width * 7 / 8, height / 4, d.whole(2, 6), ink(d));
  }
  return c.t;
}

int poster_material(Set& set, Dice& d, int size) {
  Material m = plain({1, 1, 1});
  m.pattern = Pattern::picture;
  m.picture = set.add(poster(d, size, size));
  if (d.chance(0.3f)) m.gloss = 0.04f;
  return set.add(m);
}

}  // namespace ps::rooms
