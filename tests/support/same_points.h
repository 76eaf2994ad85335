// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>

#include "libps/geometry/point.h"

namespace ps {

/// @return whether the first `count` points of two clouds are the same, bit for bit in every field
inline bool same_points(const Cloud& a, const Cloud& b, std::size_t count) {
  if (a.size() < count || b.size() < count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const Point &p = a[i], &q = b[i];
    if (std::memcmp(p.data, q.data, 3 * sizeof(float)) != 0 || p.rgba != q.rgba ||
        std::memcmp(&p.footprint, &q.footprint, sizeof(float)) != 0 || p.view != q.view ||
        p.origin != q.origin) {
      return false;
    }
  }
  return true;
}

inline bool same_points(const Cloud& a, const Cloud& b) {
  return a.size() == b.size() && same_points(a, b, a.size());
}

}  // namespace ps
