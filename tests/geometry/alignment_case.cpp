// SPDX-License-Identifier: BSD-3-Clause
#include "tests/geometry/alignment_case.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libps/core/random.h"
#include "libps/rooms/camera.h"
#include "libps/rooms/shot.h"
#include "tests/support/box_world.h"

namespace ps {

Depth distorted(const Depth& truth, const Distortion& distortion, std::uint32_t seed) {
  double phase[3];
  for (std::uint32_t i = 0; i < 3; ++i) phase[i] = 2 * M_PI * random_unit(5, {seed, i, 0, 0});
  Depth estimate(truth.size(), 0.f);
  for (int y = 0; y < truth.rows; ++y) {
    for (int x = 0; x < truth.cols; ++x) {
      if (!(truth(y, x) > 0)) continue;
      const double u = static_cast<double>(x) / truth.cols, v = static_cast<double>(y) / truth.rows;
      const double waves = std::sin(5 * u + 3 * v + phase[0]) + std::sin(6 * v - 4 * u + phase[1]) +
                           std::sin(7 * u - 2 * v + phase[2]);
      const std::uint32_t at[2] = {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)};
      const double noise = distortion.noise * random_normal(9, {seed, at[0], at[1], 0})[0];
      estimate(y, x) =
          static_cast<float>(distortion.scale * std::pow(truth(y, x), distortion.exponent) *
                             std::exp(distortion.smooth / 1.5 * waves + noise));
    }
  }
  return estimate;
}

AlignmentCase hidden(const Depth& truth, cv::Rect seen) {
  AlignmentCase c{truth.clone(), {}, truth.clone(), Mask(truth.size(), std::uint8_t{0}), {}};
  c.visible(seen) = 1;
  c.missing = c.visible == 0;
  return c;
}

AlignmentCase box_world_case(int number) {
  const Intrinsics wide = intrinsics_from_fov(384, 256, 90);
  const View view = box_world_view(wide, pose_at(0.1 * number, 0, -2, 0.25 * number - 0.6));
  return hidden(view.depth, {100, 24, 184, 208});
}

AlignmentCase furnished_case(std::uint32_t seed) {
  const rooms::Room room(seed);
  rooms::CameraOptions lens;
  lens.width = 320;
  lens.height = 240;
  lens.min_fov = 60;
  lens.max_fov = 80;
  const rooms::Camera first = rooms::random_camera(room, seed, lens);
  const rooms::Camera second = rooms::moved(room, first, seed, 0.6f, 0.4f);
  std::vector<float> depth = rooms::shoot_depth(room, second);
  std::vector<std::uint8_t> seen = rooms::seen_from(room, first, second, depth);
  const Depth truth(second.height, second.width, depth.data());
  AlignmentCase c{truth.clone(), {}, truth.clone(), {}, {}};
  c.visible = Mask(second.height, second.width, seen.data()).clone();
  c.missing = c.visible == 0;
  return c;
}

double abs_rel(const Depth& depth, const AlignmentCase& c) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      if (!c.missing(y, x) || !(c.truth(y, x) > 0)) continue;
      sum += std::fabs(depth(y, x) / c.truth(y, x) - 1);
      ++count;
    }
  }
  return sum / count;
}

Depth fitted(const AlignmentCase& c, const AlignedDepth& aligned) {
  Depth depth;
  cv::pow(c.estimate, aligned.exponent, depth);
  return depth * aligned.scale;
}

Depth median_scaled(const AlignmentCase& c) {
  std::vector<float> ratios;
  for (int y = 0; y < c.truth.rows; ++y) {
    for (int x = 0; x < c.truth.cols; ++x) {
      if (c.visible(y, x)) ratios.push_back(c.cloud(y, x) / c.estimate(y, x));
    }
  }
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return c.estimate * *middle;
}

}  // namespace ps
