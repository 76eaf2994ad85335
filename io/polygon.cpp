// SPDX-License-Identifier: BSD-3-Clause
#include "io/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ps {
namespace {

using Point = std::array<double, 2>;

constexpr std::size_t kMostEars = 256;

/// The corners in their plane's two widest axes, turning to the left.
void flatten(const std::vector<std::array<float, 3>>& corners, std::vector<Point>& flat) {
  std::array<double, 3> normal{};  // Newell's: the polygon's area seen along each axis
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      normal[axis] += (static_cast<double>(a[u]) - b[u]) * (static_cast<double>(a[v]) + b[v]);
    }
  }
  const auto larger = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto widest = std::max_element(normal.begin(), normal.end(), larger);
  const auto axis = static_cast<std::size_t>(widest - normal.begin());
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  flat.clear();
  for (const auto& corner : corners) {
    flat.push_back(*widest < 0 ? Point{corner[v], corner[u]} : Point{corner[u], corner[v]});
  }
}

/// Twice the area of a, b, c; positive when they turn to the left.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool inside(const Point& p, const Point& a, const Point& b, const Point& c) {
  return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
         turn(c, a, p) >= 0;
}

}  // namespace

void triangulate(const std::vector<std::array<float, 3>>& corners,
                 std::vector<std::array<std::size_t, 3>>& triangles) {
  thread_local std::vector<std::size_t> left;  // models have very many small polygons
  thread_local std::vector<Point> flat;
  left.resize(corners.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  triangles.clear();
  const bool simple = left.size() > 3 && left.size() <= kMostEars;
  if (simple) flatten(corners, flat);
  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = left.size();
    const Point &a = flat[left[(i + n - 1) % n]], &b = flat[left[i]], &c = flat[left[(i + 1) % n]];
    return turn(a, b, c) > 0 && std::none_of(left.begin(), left.end(), [&](std::size_t corner) {
             return inside(flat[corner], a, b, c);
           });
  };
  while (simple && left.size() > 3) {
    std::size_t ear = 0;
    while (ear < left.size() && !is_ear(ear)) ++ear;
    if (ear == left.size()) break;
    const std::size_t n = left.size();
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  for (std::size_t i = 2; i < left.size(); ++i) {
    triangles.push_back({left[0], left[i - 1], left[i]});
  }
}

}  // namespace ps
