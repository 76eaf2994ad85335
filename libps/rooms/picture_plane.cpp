// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/picture_plane.h"

#include <algorithm>
#include <cmath>

#include "libps/rooms/plane_smoother.h"

namespace ps::rooms {
namespace {

constexpr float kRough = 0.04f;  ///< roughness from which reflections are smoothed

bool same_surface(const Pixel& a, const Pixel& b, float depth) {
  if (!a.material || !b.material) return false;
  return dot(a.normal, b.normal) > 0.93f &&
         std::abs(dot(a.flat, b.position - a.position)) < 0.012f * depth;
}

}  // namespace

PicturePlane::PicturePlane(int w, int h)
    : width(w),
      height(h),
      pixels(static_cast<std::size_t>(w) * h),
      depth(pixels.size()),
      light(pixels.size()),
      mirror(pixels.size()),
      row_ends(pixels.size()),
      column_ends(pixels.size()) {}

void PicturePlane::find_ends() {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = index(x, y);
      const auto ends = [&](std::size_t before) {
        return same_surface(pixels[before], pixels[i], depth[i]) ? 0 : 1;
      };
      if (x > 0) row_ends[i] = static_cast<std::uint16_t>(row_ends[i - 1] + ends(i - 1));
      if (y > 0) {
        column_ends[i] = static_cast<std::uint16_t>(column_ends[i - width] + ends(i - width));
      }
    }
  }
}

void PicturePlane::smooth_light() {
  PlaneSmoother smoother(*this, light);
  smoother.share(1);
  for (const int apart : {3, 5}) smoother.share_alike(apart);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) light[index(x, y)] = smoother.at(x, y);
  }
}

void PicturePlane::smooth_mirror() {
  const auto is_rough = [](const Pixel& p) {
    return p.reflected > 0 && p.material->roughness >= kRough;
  };
  if (std::none_of(pixels.begin(), pixels.end(), is_rough)) return;
  PlaneSmoother smoother(*this, mirror);
  for (const int apart : {1, 4}) smoother.share(apart);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (is_rough(pixels[index(x, y)])) mirror[index(x, y)] = smoother.at(x, y);
    }
  }
}

std::vector<std::uint32_t> PicturePlane::edges() const {
  std::vector<std::uint32_t> found;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = index(x, y);
      const auto differs = [&](std::size_t j, const std::vector<std::uint16_t>& ends) {
        return ends[i] != ends[j] || pixels[i].material != pixels[j].material;
      };
      if ((x > 0 && differs(i - 1, row_ends)) || (x + 1 < width && differs(i + 1, row_ends)) ||
          (y > 0 && differs(i - width, column_ends)) ||
          (y + 1 < height && differs(i + width, column_ends))) {
        found.push_back(static_cast<std::uint32_t>(i));
      }
    }
  }
  return found;
}

}  // namespace ps::rooms
