// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/plane_smoother.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "libps/rooms/dice.h"

namespace ps::rooms {
namespace {

/// Surfaces of a few pixels each, at random.
PicturePlane random_plane(Dice& d, int width, int height) {
  PicturePlane plane(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = plane.index(x, y);
      const auto next = [&](std::uint16_t before) {
        return static_cast<std::uint16_t>(before + (d.chance(0.2f) ? 1 : 0));
      };
      if (x > 0) plane.row_ends[i] = next(plane.row_ends[i - 1]);
      if (y > 0) plane.column_ends[i] = next(plane.column_ends[i - width]);
      plane.light[i] = {d.range(0, 2), d.range(0, 2), d.range(0, 2)};
    }
  }
  return plane;
}

/// The weight of what is seen at pixel k where i looks.
using Weight = float (*)(Vec here, Vec there, int taps_away);

float evenly(Vec, Vec, int away) { return std::abs(away) == 2 ? 0.5f : 1.f; }
float alike(Vec here, Vec there, int away) {
  if (away == 0) return 2;
  const float a = luminance(here), b = luminance(there);
  const float differs = (b - a) / (0.1f * (b + a) + 1e-6f);
  return 1 / (1 + differs * differs);
}

/// One line of pixels after the other, one tap after the other.
std::vector<Vec> smoothed(const PicturePlane& p, std::vector<Vec> image, Weight weight, int reach,
                          int apart) {
  for (const bool along_x : {true, false}) {
    const std::vector<Vec> before = image;
    const auto& ends = along_x ? p.row_ends : p.column_ends;
    for (int y = 0; y < p.height; ++y) {
      for (int x = 0; x < p.width; ++x) {
        const std::size_t i = p.index(x, y);
        Vec sum;
        float total = 0;
        for (int t = -reach; t <= reach; ++t) {
          const int u = x + (along_x ? t * apart : 0), v = y + (along_x ? 0 : t * apart);
          if (u < 0 || v < 0 || u >= p.width || v >= p.height) continue;
          const std::size_t k = p.index(u, v);
          if (ends[k] != ends[i]) continue;
          const float w = weight(before[i], before[k], t);
          sum += before[k] * w;
          total += w;
        }
        image[i] = sum * (1 / total);
      }
    }
  }
  return image;
}

void expect_near(const PlaneSmoother& smoother, const PicturePlane& p,
                 const std::vector<Vec>& wanted) {
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      const Vec found = smoother.at(x, y), want = wanted[p.index(x, y)];
      ASSERT_NEAR(found.x, want.x, 2e-6f) << x << " " << y;
      ASSERT_NEAR(found.y, want.y, 2e-6f) << x << " " << y;
      ASSERT_NEAR(found.z, want.z, 2e-6f) << x << " " << y;
    }
  }
}

TEST(PlaneSmoother, shares_light_within_surfaces_alone) {
  Dice d(1, 1);
  for (const auto& [width, height] : {std::pair{1, 1}, {37, 21}, {16, 3}, {5, 48}, {64, 64}}) {
    const PicturePlane plane = random_plane(d, width, height);
    for (const int apart : {1, 4}) {
      PlaneSmoother smoother(plane, plane.light);
      smoother.share(apart);
      expect_near(smoother, plane, smoothed(plane, plane.light, evenly, 2, apart));
    }
    for (const int apart : {3, 5}) {
      PlaneSmoother smoother(plane, plane.light);
      smoother.share_alike(apart);
      expect_near(smoother, plane, smoothed(plane, plane.light, alike, 1, apart));
    }
  }
}

}  // namespace
}  // namespace ps::rooms
