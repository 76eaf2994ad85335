// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/geometry/point.h"
#include "tests/io/support.h"

namespace ps {

inline Cloud random_cloud(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> metres(0, 3);
  Cloud cloud;
  cloud.resize(count);
  for (Point& p : cloud.points) {
    p.x = metres(random);
    p.y = metres(random);
    p.z = metres(random);
    p.rgba = 0xff000000u | (random() & 0xffffffu);
    p.footprint = std::abs(metres(random)) * 1e-3f;
    p.view = static_cast<std::uint16_t>(random());
    p.origin = random() & 1;
  }
  return cloud;
}

inline void expect_same(const Cloud& a, const Cloud& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(b.width, a.size());
  EXPECT_EQ(b.height, 1u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Point &p = a[i], &q = b[i];
    const bool same = p.x == q.x && p.y == q.y && p.z == q.z && p.rgba == q.rgba &&
                      p.footprint == q.footprint && p.view == q.view && p.origin == q.origin;
    ASSERT_TRUE(same) << "point " << i;
  }
}

inline std::uint32_t rgb(const Point& point) { return point.rgba & 0xffffffu; }

}  // namespace ps
