// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/lone_pixels.h"

#include <algorithm>
#include <cmath>

#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr int kReach = 2, kLeastAgreeing = 2;
constexpr double kLeastShare = .15;

bool alone(const Depth& depth, int x, int y, double tolerance) {
  const float d = depth(y, x);
  int known = 0, agree = 0;
  for (int v = std::max(0, y - kReach); v <= std::min(depth.rows - 1, y + kReach); ++v) {
    for (int u = std::max(0, x - kReach); u <= std::min(depth.cols - 1, x + kReach); ++u) {
      if ((u == x && v == y) || !(depth(v, u) > 0)) continue;
      ++known;
      agree += std::fabs(depth(v, u) - d) <= tolerance * d;
    }
  }
  return known > kLeastAgreeing && agree < kLeastAgreeing && agree < kLeastShare * known;
}

}  // namespace

Mask lone_pixels(const Depth& depth, double tolerance) {
  Mask result = Mask::zeros(depth.size());
  parallel_for(depth.rows, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < depth.cols; ++x) {
      if (depth(y, x) > 0) result(y, x) = alone(depth, x, y, tolerance) ? 1 : 0;
    }
  });
  return result;
}

}  // namespace ps
