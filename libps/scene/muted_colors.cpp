// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/muted_colors.h"

#include <algorithm>
#include <vector>

#include "libps/geometry/point.h"

namespace ps {
namespace {

constexpr std::size_t kMostPoints = 20000;
constexpr double kStronger = .001;  ///< share of points
constexpr int kGreyLevels = 2;
constexpr float kFaded = .1f, kRise = 10;

}  // namespace

float color_limit(const Cloud& cloud) {
  if (cloud.empty()) return 1;
  const std::size_t step = (cloud.size() + kMostPoints - 1) / kMostPoints;
  std::vector<int> levels;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    const Point& p = cloud[i];
    const auto [least, most] = std::minmax({int{p.r}, int{p.g}, int{p.b}});
    levels.push_back(most - least);
  }
  const auto at = levels.end() - 1 -
                  static_cast<std::ptrdiff_t>(kStronger * static_cast<double>(levels.size()));
  std::nth_element(levels.begin(), at, levels.end());
  if (*at <= kGreyLevels) return 0;
  const float limit = static_cast<float>(*at) / 255;
  return std::min(1.f, limit + kRise * std::max(0.f, limit - kFaded));
}

Image muted(const Image& image, float limit) {
  Image out = image.clone();
  for (cv::Vec3f& c : out) {
    const auto [least, most] = std::minmax({c[0], c[1], c[2]});
    const float strength = most - least;
    if (strength <= limit) continue;
    const float luma = .299f * c[0] + .587f * c[1] + .114f * c[2];
    for (int k = 0; k < 3; ++k) c[k] = luma + (c[k] - luma) * (limit / strength);
  }
  return out;
}

}  // namespace ps
