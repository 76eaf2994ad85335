// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/builder.h"

#include <cmath>

namespace ps::rooms {
namespace {

constexpr float kTurn = 6.2831853f;

/// sin or cos drawn towards the corners of a box.
float squared(float x, float power) { return std::copysign(std::pow(std::abs(x), power), x); }

}  // namespace

float Builder::offset() { return hash(static_cast<int>(mesh_.corners.size()), 17, 5) * 10; }

std::uint32_t Builder::corner(Vec position, Vec normal, float u, float v) {
  mesh_.corners.push_back({frame_.point(position), normalized(frame_.direction(normal)), u, v});
  return static_cast<std::uint32_t>(mesh_.corners.size() - 1);
}

void Builder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, int material) {
  mesh_.faces.push_back({{a, b, c}, static_cast<std::uint32_t>(material)});
}

void Builder::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                   int material) {
  triangle(a, b, c, material);
  triangle(a, c, d, material);
}

void Builder::flat(const std::array<Vec, 4>& p, int material) {
  const Vec eu = normalized(p[1] - p[0]);
  const Vec n = normalized(cross(p[1] - p[0], p[3] - p[0]));
  const Vec ev = cross(n, eu);
  const float start = offset();
  std::uint32_t c[4];
  for (int i = 0; i < 4; ++i) {
    c[i] = corner(p[i], n, start + dot(p[i] - p[0], eu), start + dot(p[i] - p[0], ev));
  }
  quad(c[0], c[1], c[2], c[3], material);
}

void Builder::sheet(Vec a, Vec eu, Vec ev, int material) {
  flat({a, a + eu, a + eu + ev, a + ev}, material);
}

void Builder::panel(float x0, float y0, float x1, float y1, int material) {
  const Vec n{0, 0, 1};
  quad(corner({x0, y0, 0}, n, x0, y0), corner({x1, y0, 0}, n, x1, y0),
       corner({x1, y1, 0}, n, x1, y1), corner({x0, y1, 0}, n, x0, y1), material);
}

void Builder::picture(Vec a, Vec eu, Vec ev, int material) {
  const Vec n = cross(eu, ev);
  quad(corner(a, n, 0, 0), corner(a + eu, n, 1, 0), corner(a + eu + ev, n, 1, 1),
       corner(a + ev, n, 0, 1), material);
}

void Builder::box(Vec l, Vec h, int material, float bevel) {
  const Vec size = h - l;
  const float b = std::min(bevel, 0.45f * std::min(size.x, std::min(size.y, size.z)));
  const float start = offset();
  // Grain (u) runs along the longest side.
  const float low[3] = {l.x, l.y, l.z}, high[3] = {h.x, h.y, h.z};
  const int longest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  // c[axis][side][i][j]: corner of that face, i and j along the next two axes.
  std::uint32_t c[3][2][2][2];
  for (int axis = 0; axis < 3; ++axis) {
    const int p = (axis + 1) % 3, q = (axis + 2) % 3;
    for (int side = 0; side < 2; ++side) {
      float n[3] = {0, 0, 0};
      n[axis] = side ? 1.f : -1.f;
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
          float x[3];
          x[axis] = side ? high[axis] : low[axis];
          x[p] = i ? high[p] - b : low[p] + b;
          x[q] = j ? high[q] - b : low[q] + b;
          const bool swap = q == longest || (p == 1 && longest != 1);
          const float u = x[swap ? q : p], v = x[swap ? p : q];
          c[axis][side][i][j] =
              corner({x[0], x[1], x[2]}, {n[0], n[1], n[2]}, start + u, start + v);
        }
      }
      const auto& f = c[axis][side];
      quad(f[0][0], f[1][0], f[1][1], f[0][1], material);
    }
  }
  if (b <= 0) return;
  for (int axis = 0; axis < 3; ++axis) {  // edges between the faces of `axis` and the next one
    const int p = (axis + 1) % 3;
    for (int s = 0; s < 2; ++s) {
      for (int t = 0; t < 2; ++t) {
        // Face `axis` has i along p; face p has j along `axis`; the edge runs along the third.
        quad(c[axis][s][t][0], c[axis][s][t][1], c[p][t][1][s], c[p][t][0][s], material);
        for (int r = 0; axis == 0 && r < 2; ++r) {
          triangle(c[0][s][t][r], c[1][t][r][s], c[2][r][s][t], material);
        }
      }
    }
  }
}

void Builder::tapered(Vec l, Vec h, float taper, int material) {
  const Vec m = (l + h) * 0.5f, d = (h - l) * 0.5f;
  const auto at = [&](float x, float z, bool top) {
    const float k = top ? taper : 1.f;
    return Vec{m.x + x * d.x * k, top ? h.y : l.y, m.z + z * d.z * k};
  };
  const float ring[5][2] = {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}, {-1, 1}};
  for (int i = 0; i < 4; ++i) {
    const float *p = ring[i], *q = ring[i + 1];
    flat({at(p[0], p[1], false), at(q[0], q[1], false), at(q[0], q[1], true), at(p[0], p[1], true)},
         material);
  }
  for (const bool top : {false, true}) {
    flat({at(-1, 1, top), at(1, 1, top), at(1, -1, top), at(-1, -1, top)}, material);
  }
}

void Builder::lathe(Vec base, const std::vector<std::array<float, 2>>& profile, int material,
                    int sides, bool smooth) {
  const float start = offset();
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const float r0 = profile[k][0], y0 = profile[k][1], r1 = profile[k + 1][0],
                y1 = profile[k + 1][1];
    std::uint32_t before[2] = {0, 0};
    for (int i = 0; i <= sides; ++i) {
      const float angle = kTurn * static_cast<float>(i) / static_cast<float>(sides);
      const float c = std::cos(angle), s = std::sin(angle);
      const float shade = kTurn * (static_cast<float>(i) - 0.5f) / static_cast<float>(sides);
      const Vec n = smooth ? Vec{c * (y1 - y0), r0 - r1, s * (y1 - y0)}
                           : Vec{std::cos(shade) * (y1 - y0), r0 - r1, std::sin(shade) * (y1 - y0)};
      const float u = start + angle * std::max(r0, r1);
      const std::uint32_t now[2] = {corner(base + Vec{c * r0, y0, s * r0}, n, u, start + y0),
                                    corner(base + Vec{c * r1, y1, s * r1}, n, u, start + y1)};
      if (i > 0) quad(before[0], now[0], now[1], before[1], material);
      before[0] = now[0];
      before[1] = now[1];
    }
  }
}

void Builder::cylinder(Vec base, float radius, float height, int material, float top_radius,
                       int sides) {
  const float top = top_radius < 0 ? radius : top_radius;
  lathe(base, {{0, 0}, {radius, 0}, {top, height}, {0, height}}, material, sides);
}

void Builder::rod(Vec a, Vec b, float radius, int material, int sides) {
  const Vec y = normalized(b - a);
  const Vec x = normalized(cross(std::abs(y.y) < 0.9f ? Vec{0, 1, 0} : Vec{1, 0, 0}, y));
  in({x, y, cross(x, y), a})
      .lathe({}, {{0, 0}, {radius, 0}, {radius, length(b - a)}, {0, length(b - a)}}, material,
             sides);
}

void Builder::cushion(Vec low, Vec high, int material, float power, int steps) {
  const Vec m = (low + high) * 0.5f, r = (high - low) * 0.5f;
  const int around = 2 * steps;
  const float start = offset();
  std::vector<std::uint32_t> before, now;
  for (int i = 0; i <= steps; ++i) {
    const float a = (static_cast<float>(i) / static_cast<float>(steps) - 0.5f) * kTurn / 2;
    now.clear();
    for (int j = 0; j <= around; ++j) {
      const float b = static_cast<float>(j) / static_cast<float>(around) * kTurn;
      const float ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
      const Vec p{squared(ca, power) * squared(cb, power), squared(sa, power),
                  squared(ca, power) * squared(sb, power)};
      const float q = 2 - power;  // the normal of a superellipsoid is one itself
      const Vec n{squared(ca, q) * squared(cb, q) / r.x, squared(sa, q) / r.y,
                  squared(ca, q) * squared(sb, q) / r.z};
      now.push_back(corner(m + p * r, n, start + b * r.x, start + a * std::max(r.y, r.z)));
    }
    for (int j = 0; i > 0 && j < around; ++j) {
      quad(before[j], before[j + 1], now[j + 1], now[j], material);
    }
    std::swap(before, now);
  }
}

void Builder::leaf(Vec root, Vec along, Vec across, float droop, int material) {
  const float width[5] = {0.15f, 0.85f, 1, 0.6f, 0};
  std::uint32_t before[2] = {0, 0};
  for (int i = 0; i < 5; ++i) {
    const float t = static_cast<float>(i) / 4;
    const Vec middle = root + along * t - Vec{0, droop * t * t, 0};
    const Vec n = cross(across, along - Vec{0, 2 * droop * t, 0});
    const Vec half = across * (0.5f * width[i]);
    const std::uint32_t now[2] = {corner(middle - half, n, 0, t),
                                  corner(middle + half, n, 0.1f, t)};
    if (i > 0) quad(before[0], now[0], now[1], before[1], material);
    before[0] = now[0];
    before[1] = now[1];
  }
}

void Builder::curtain(Vec low, float width, float height, float depth, int folds, int material,
                      float phase) {
  const int steps = folds * 6;
  std::uint32_t before[2] = {0, 0};
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const float a = t * static_cast<float>(folds) * kTurn + phase;
    const float wide = depth * (1 + 0.4f * std::sin(a * 0.37f));
    const float slope = wide * std::cos(a) * static_cast<float>(folds) * kTurn / width;
    const Vec p = low + Vec{t * width, 0, wide * std::sin(a)};
    const float u = t * width * 1.6f;
    const std::uint32_t now[2] = {corner(p, {-slope, 0, 1}, u, 0),
                                  corner(p + Vec{0, height, 0}, {-slope, 0, 1}, u, height)};
    if (i > 0) quad(before[0], now[0], now[1], before[1], material);
    before[0] = now[0];
    before[1] = now[1];
  }
}

void Builder::prism(const std::vector<std::array<float, 2>>& outline, float low, float high,
                    int material) {
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto& p = outline[i];
    const auto& q = outline[(i + 1) % n];
    flat({Vec{p[0], low, p[1]}, Vec{q[0], low, q[1]}, Vec{q[0], high, q[1]}, Vec{p[0], high, p[1]}},
         material);
  }
  for (const float y : {low, high}) {  // fans: outlines are convex
    std::vector<std::uint32_t> c;
    for (const auto& p : outline) c.push_back(corner({p[0], y, p[1]}, {0, 1, 0}, p[0], p[1]));
    for (std::size_t i = 1; i + 1 < n; ++i) triangle(c[0], c[i], c[i + 1], material);
  }
}

}  // namespace ps::rooms
