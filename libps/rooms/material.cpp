// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/material.h"

#include <array>
#include <cmath>

#include "libps/rooms/four.h"

namespace ps::rooms {
namespace {

int floor_of(float x) {
  const int i = static_cast<int>(x);
  return i - (x < static_cast<float>(i) ? 1 : 0);
}
float part_of(float x) { return x - static_cast<float>(floor_of(x)); }

/// How much of a detail of this size is still seen.
float seen(float size, float footprint) { return clamp01(1.5f - footprint / size * 1.5f); }

/// Noise of three sizes, about 0, within (-1, 1).
float rough(float x, float y, std::uint32_t seed, float footprint) {
  float sum = 0.5f * (2 * noise(x, y, seed) - 1);
  if (footprint < 0.5f) sum += 0.3f * (2 * noise(2.3f * x, 2.3f * y, seed + 1) - 1);
  if (footprint < 0.2f) sum += 0.2f * (2 * noise(5.1f * x, 5.1f * y, seed + 2) - 1);
  return sum;
}

/// 1 on a line of this width about whole numbers; faded to its mean where it is finer than a pixel.
float line(float x, float width, float footprint) {
  const float d = std::abs(part_of(x + 0.5f) - 0.5f);
  const float soft = std::max(footprint, 1e-4f);
  const float sharp = clamp01((width * 0.5f - d) / soft + 0.5f);
  return mix(std::min(1.f, width), sharp, seen(0.7f, footprint));
}

Vec wood(const Material& m, float u, float v, float footprint, std::uint32_t seed, float tone) {
  // Rings cut lengthwise: stretched along u, bent by slow noise.
  const float bend = noise(u * 0.9f, v * 3.f, seed) * 2.5f;
  const float rings = noise(u * 1.3f, (v * 38.f + bend * 3), seed + 7);
  const float fibre = noise(u * 12.f, v * 260.f, seed + 9);
  float k = tone;
  k += 0.55f * (rings - 0.5f) * seen(0.03f, footprint);
  k += 0.3f * (fibre - 0.5f) * seen(0.006f, footprint);
  k += 0.5f * (noise(u * 0.5f, v * 4.f, seed + 3) - 0.5f);
  return mix(m.color, m.second, clamp01(0.5f + k * m.amount * 0.5f));
}

Vec planks(const Material& m, float u, float v, float footprint) {
  const float row = v / m.scale;
  const int r = floor_of(row);
  const float length = m.scale * (6 + 6 * hash(r, 3, m.seed));
  const float along = u / length + hash(r, 1, m.seed);
  const int c = floor_of(along);
  const float tone = 0.9f * (hash(r, c, m.seed + 5) - 0.5f);
  const Vec base =
      wood(m, u, v, footprint, m.seed + 31 * static_cast<std::uint32_t>(r * 57 + c), tone);
  const float joint = std::max(line(row, 0.03f, footprint / m.scale),
                               line(along, 0.004f / length, footprint / length));
  return base * (1 - 0.55f * joint);
}

Vec herringbone(const Material& m, float u, float v, float footprint) {
  const float side = m.scale * 4;
  const int bx = floor_of(u / side), by = floor_of(v / side);
  const bool turn = ((bx + by) & 1) != 0;
  Material block = m;
  block.seed = m.seed + 91 * static_cast<std::uint32_t>(bx * 131 + by);
  return turn ? planks(block, v, u, footprint) : planks(block, u, v, footprint);
}

Vec tiles(const Material& m, float u, float v, float footprint) {
  const float x = u / m.scale, y = v / m.scale, f = footprint / m.scale;
  const float tone = (hash(floor_of(x), floor_of(y), m.seed) - 0.5f) * 0.2f * m.amount;
  const float cloud = 0.12f * m.amount * rough(x * 2, y * 2, m.seed, 2 * f);
  const float joint = std::max(line(x, 0.02f, f), line(y, 0.02f, f));
  return mix(m.color * (1 + tone + cloud), m.second, joint);
}

Vec bricks(const Material& m, float u, float v, float footprint) {
  const float high = m.scale * 0.33f;
  const float y = v / high;
  const int row = floor_of(y);
  const float x = u / m.scale + (row & 1 ? 0.5f : 0.f);
  const float tone = (hash(floor_of(x), row, m.seed) - 0.5f) * 0.6f;
  const float cloud =
      0.35f * rough(u * 30, v * 30, m.seed, footprint * 30) * seen(0.02f, footprint);
  const float joint =
      std::max(line(x, 0.05f, footprint / m.scale), line(y, 0.15f, footprint / high));
  return mix(m.color * (1 + m.amount * (tone + cloud)), m.second, joint);
}

Vec carpet(const Material& m, float u, float v, float footprint) {
  const float fine = noise(u * 400, v * 400, m.seed) - 0.5f;
  const float middle = noise(u * 90, v * 130, m.seed + 1) - 0.5f;
  const float large = noise(u * 1.7f, v * 1.7f, m.seed + 2) - 0.5f;
  const float k = fine * seen(0.004f, footprint) + middle * seen(0.015f, footprint) + 0.25f * large;
  return mix(m.color, m.second, clamp01(0.35f + m.amount * k));
}

Vec carpet_tiles(const Material& m, float u, float v, float footprint) {
  const int x = floor_of(u / m.scale), y = floor_of(v / m.scale);
  Material one = m;
  one.seed = m.seed + static_cast<std::uint32_t>(x * 71 + y);
  if (hash(x / 2 + y, y / 3, m.seed) < 0.3f) one.color = mix(m.color, m.second, 0.55f);
  return (x + y) & 1 ? carpet(one, u, v, footprint) : carpet(one, v * 0.5f, u, footprint);
}

Vec text(const Material& m, float u, float v, float footprint) {
  if (u < 0.1f || u > 0.9f || v < 0.08f || v > 0.92f) return m.color;
  const float rows = 1 / m.scale;
  const float y = v * rows;
  const int row = floor_of(y);
  const float length = hash(row, 5, m.seed);
  const bool blank = length < 0.15f || u > 0.35f + 0.55f * hash(row, 6, m.seed) + 0.25f * length;
  const float word = noise(u * rows * 2.2f, static_cast<float>(row) * 17.f, m.seed);
  const float ink = !blank && part_of(y) > 0.3f && part_of(y) < 0.8f && word > 0.3f ? 1.f : 0.f;
  return mix(m.color, m.second,
             mix(0.3f * (blank ? 0.f : 1.f), ink, seen(m.scale * 0.7f, footprint)));
}

Vec blobs(const Material& m, float u, float v, float footprint) {
  const float x = u / m.scale, y = v / m.scale;
  const float k = noise(x, y, m.seed) + 0.4f * noise(x * 2.7f, y * 2.7f, m.seed + 1);
  const float soft = 0.04f + footprint / m.scale;
  return mix(m.color, m.second, m.amount * smooth_step(0.8f - soft, 0.8f + soft, k));
}

Vec marble(const Material& m, float u, float v, float footprint) {
  const float x = u / m.scale, y = v / m.scale, f = footprint / m.scale;
  const float k = std::abs(rough(x, y, m.seed, f) + 0.3f * rough(3 * x, 3 * y, m.seed + 9, 3 * f));
  return mix(m.second, m.color, mix(1.f, clamp01(0.3f + 4 * k), 0.7f * m.amount));
}

Vec weave(const Material& m, float u, float v, float footprint) {
  const float x = u / m.scale, y = v / m.scale;
  const float thread = std::sin(x * 6.2832f) * std::sin(y * 6.2832f);
  const float k =
      0.5f * thread * seen(m.scale, footprint) + 0.5f * (noise(u * 9, v * 9, m.seed) - 0.5f);
  return mix(m.color, m.second, clamp01(0.3f + 0.5f * m.amount * k));
}

const std::array<float, 256>& linear_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (int i = 0; i < 256; ++i) t[i] = linear_from_srgb(static_cast<float>(i) / 255);
    return t;
  }();
  return table;
}

}  // namespace

float noise(float x, float y, std::uint32_t seed) {
  typedef std::uint32_t Bits __attribute__((vector_size(16)));
  typedef std::int32_t Whole __attribute__((vector_size(16)));
  const int i = floor_of(x), j = floor_of(y);
  float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  a = a * a * (3 - 2 * a);
  b = b * b * (3 - 2 * b);
  // hash() at (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1), side by side.
  const std::uint32_t x0 = static_cast<std::uint32_t>(i) * 0x8da6b343u, x1 = x0 + 0x8da6b343u;
  const std::uint32_t y0 = static_cast<std::uint32_t>(j) * 0xd8163841u, y1 = y0 + 0xd8163841u;
  Bits h = Bits{x0 ^ y0, x1 ^ y0, x0 ^ y1, x1 ^ y1} ^ (seed * 0xcb1ab31fu);
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  h ^= h >> 15;
  const Four v = __builtin_convertvector(reinterpret_cast<Whole>(h >> 8), Four) * 0x1p-24f;
  return mix(mix(v[0], v[1], a), mix(v[2], v[3], a), b);
}

Vec albedo(const Material& m, const std::vector<Picture>& pictures, float u, float v,
           float footprint) {
  const float x = u / m.scale, y = v / m.scale, f = footprint / m.scale;
  switch (m.pattern) {
    case Pattern::plain:
      return m.color;
    case Pattern::plaster:
      return m.color * (1 + 0.1f * m.amount * rough(x, y, m.seed, f));
    case Pattern::wood:
      return wood(m, u, v, footprint, m.seed, 0);
    case Pattern::planks:
      return planks(m, u, v, footprint);
    case Pattern::herringbone:
      return herringbone(m, u, v, footprint);
    case Pattern::tiles:
      return tiles(m, u, v, footprint);
    case Pattern::bricks:
      return bricks(m, u, v, footprint);
    case Pattern::carpet:
      return carpet(m, u, v, footprint);
    case Pattern::carpet_tiles:
      return carpet_tiles(m, u, v, footprint);
    case Pattern::stripes:
      return mix(m.color, m.second, m.amount * line(x, 0.4f, f));
    case Pattern::checks:
      return mix(m.color, m.second, 0.5f * m.amount * (line(x, 0.5f, f) + line(y, 0.5f, f)));
    case Pattern::weave:
      return weave(m, u, v, footprint);
    case Pattern::marble:
      return marble(m, u, v, footprint);
    case Pattern::speckle:
      return mix(m.color, m.second,
                 m.amount * seen(m.scale, footprint) *
                     smooth_step(0.6f, 0.75f, noise(x * 2, y * 2, m.seed)));
    case Pattern::blobs:
      return blobs(m, u, v, footprint);
    case Pattern::text:
      return text(m, u, v, footprint);
    case Pattern::grooves:
      return mix(m.color, m.second, m.amount * line(y, 0.12f, f));
    case Pattern::picture:
      return m.color * pictures[m.picture].at(u, v, footprint);
  }
  return m.color;
}

Picture::Picture(const Texture& texture) {
  levels_.push_back({texture.width, texture.height, texture.rgb});
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level half{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
    half.rgb.resize(static_cast<std::size_t>(half.width) * half.height * 3);
    for (int y = 0; y < half.height; ++y) {
      for (int x = 0; x < half.width; ++x) {
        const int x1 = std::min(fine.width - 1, 2 * x + 1),
                  y1 = std::min(fine.height - 1, 2 * y + 1);
        for (int c = 0; c < 3; ++c) {
          const auto texel = [&](int i, int j) {
            return fine.rgb[(static_cast<std::size_t>(j) * fine.width + i) * 3 + c];
          };
          half.rgb[(static_cast<std::size_t>(y) * half.width + x) * 3 + c] =
              static_cast<std::uint8_t>((texel(std::min(2 * x, x1), std::min(2 * y, y1)) +
                                         texel(x1, std::min(2 * y, y1)) +
                                         texel(std::min(2 * x, x1), y1) + texel(x1, y1) + 2) /
                                        4);
        }
      }
    }
    levels_.push_back(std::move(half));
  }
}

Vec Picture::at(float u, float v, float footprint) const {
  const float texels =
      footprint * static_cast<float>(std::max(levels_[0].width, levels_[0].height));
  int level = 0;
  while (level + 1 < static_cast<int>(levels_.size()) &&
         texels > static_cast<float>(2 << level) * 0.75f)
    ++level;
  const Level& l = levels_[level];
  const float x = part_of(u) * static_cast<float>(l.width) - 0.5f;
  const float y = part_of(1 - v) * static_cast<float>(l.height) - 0.5f;
  const int i = floor_of(x), j = floor_of(y);
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  const auto texel = [&](int p, int q) {
    p = p < 0 ? l.width - 1 : p >= l.width ? 0 : p;
    q = q < 0 ? l.height - 1 : q >= l.height ? 0 : q;
    const std::uint8_t* t = &l.rgb[(static_cast<std::size_t>(q) * l.width + p) * 3];
    const auto& table = linear_table();
    return Vec{table[t[0]], table[t[1]], table[t[2]]};
  };
  return mix(mix(texel(i, j), texel(i + 1, j), a), mix(texel(i, j + 1), texel(i + 1, j + 1), a), b);
}

}  // namespace ps::rooms
