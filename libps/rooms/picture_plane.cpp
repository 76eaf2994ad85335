// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/picture_plane.h"

#include <algorithm>
#include <cmath>

namespace ps::rooms {
namespace {

constexpr float kRough = 0.04f;  ///< roughness from which reflections are smoothed

bool same_surface(const Pixel& a, const Pixel& b, float depth) {
  if (!a.material || !b.material) return false;
  return dot(a.normal, b.normal) > 0.93f &&
         std::abs(dot(a.flat, b.position - a.position)) < 0.012f * depth;
}

/// One row or column: where it starts, how far apart its pixels are, how many.
struct Line {
  std::size_t start, step;
  int count;
};

template <typename F>
void over_lines(const PicturePlane& p, F f) {
  for (int y = 0; y < p.height; ++y) f(Line{p.index(0, y), 1, p.width}, p.row_ends);
  for (int x = 0; x < p.width; ++x) {
    f(Line{p.index(x, 0), static_cast<std::size_t>(p.width), p.height}, p.column_ends);
  }
}

/// The mean over five pixels of one surface, `apart` pixels apart; ends weigh half, so that each of
/// four samples that repeat weighs the same.
void share(std::vector<Vec>& image, std::vector<Vec>& line, const Line& l,
           const std::vector<std::uint16_t>& ends, int apart) {
  static const float weight[5] = {0.5f, 1, 1, 1, 0.5f};
  for (int i = 0; i < l.count; ++i) line[i] = image[l.start + i * l.step];
  for (int i = 0; i < l.count; ++i) {
    const std::uint16_t end = ends[l.start + i * l.step];
    Vec sum;
    float total = 0;
    for (int n = -2; n <= 2; ++n) {
      const int k = i + n * apart;
      if (k < 0 || k >= l.count || ends[l.start + k * l.step] != end) continue;
      sum += line[k] * weight[n + 2];
      total += weight[n + 2];
    }
    image[l.start + i * l.step] = sum * (1 / total);
  }
}

/// The mean over three pixels of one surface, `apart` pixels apart, where their light is alike.
void share_alike(std::vector<Vec>& image, std::vector<Vec>& line, const Line& l,
                 const std::vector<std::uint16_t>& ends, int apart) {
  for (int i = 0; i < l.count; ++i) line[i] = image[l.start + i * l.step];
  for (int i = 0; i < l.count; ++i) {
    const std::uint16_t end = ends[l.start + i * l.step];
    const float here = luminance(line[i]);
    Vec sum = line[i] * 2;
    float total = 2;
    for (const int k : {i - apart, i + apart}) {
      if (k < 0 || k >= l.count || ends[l.start + k * l.step] != end) continue;
      const float there = luminance(line[k]);
      const float differs = (there - here) / (0.1f * (there + here) + 1e-6f);
      const float w = 1 / (1 + differs * differs);
      sum += line[k] * w;
      total += w;
    }
    image[l.start + i * l.step] = sum * (1 / total);
  }
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
  std::vector<Vec> line(std::max(width, height));
  over_lines(*this, [&](const Line& l, const auto& ends) { share(light, line, l, ends, 1); });
  for (const int apart : {3, 5}) {
    over_lines(*this,
               [&](const Line& l, const auto& ends) { share_alike(light, line, l, ends, apart); });
  }
}

void PicturePlane::smooth_mirror() {
  const std::vector<Vec> before = mirror;
  bool any = false;
  for (const Pixel& p : pixels) {
    any |= p.reflected > 0 && p.material->roughness >= kRough;
  }
  if (!any) return;
  std::vector<Vec> line(std::max(width, height));
  for (const int apart : {1, 4}) {
    over_lines(*this,
               [&](const Line& l, const auto& ends) { share(mirror, line, l, ends, apart); });
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Pixel& p = pixels[i];
    if (p.reflected > 0 && p.material->roughness < kRough) mirror[i] = before[i];
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
