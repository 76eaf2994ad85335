// SPDX-License-Identifier: BSD-3-Clause
// Clouds of one point for each pixel of a camera, and pictures of them, for tests of the budget.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "libps/core/random.h"
#include "libps/eval/image_metrics.h"
#include "libps/geometry/lift.h"
#include "libps/scene/budget.h"
#include "libps/scene/closed_splat.h"

namespace ps {

inline const Intrinsics kCamera{160, 120, 120, 120, 79.5, 59.5};
inline const std::vector<PlannedView> kFront = {{kCamera, Pose::Identity()}};

using ColorOf = std::function<cv::Vec3f(int x, int y)>;
using DepthOf = std::function<float(int x, int y)>;

/// One point for each pixel of the camera at the origin.
inline Cloud picture_cloud(const ColorOf& color, const DepthOf& depth,
                           Origin origin = Origin::observed) {
  View view;
  view.intrinsics = kCamera;
  view.color.create(kCamera.height, kCamera.width);
  view.depth.create(kCamera.height, kCamera.width);
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      view.color(y, x) = color(x, y);
      view.depth(y, x) = depth(x, y);
    }
  }
  LiftOptions keep_all;
  keep_all.edge_footprints = 0;
  return lift(view, 0, origin, keep_all);
}

inline float two_metres(int, int) { return 2; }

inline cv::Vec3f plain(int, int) { return {0.2f, 0.6f, 0.4f}; }

inline cv::Vec3f smooth(int x, int y) {
  const auto u = static_cast<float>(x), v = static_cast<float>(y);
  return {0.2f + 0.003f * u, 0.5f + 0.1f * std::sin(0.03f * v), 0.7f - 0.002f * u};
}

inline cv::Vec3f noise(int x, int y) {
  const auto number = [&](std::uint32_t channel) {
    return static_cast<float>(
        random_unit(7, {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), channel, 0}));
  };
  return {number(0), number(1), number(2)};
}

inline cv::Vec3f chequers(int x, int y) {
  return (x / 3 + y / 3) % 2 == 0 ? cv::Vec3f(0.1f, 0.1f, 0.1f) : cv::Vec3f(0.9f, 0.9f, 0.9f);
}

/// Plain to the left, chequered to the right.
inline cv::Vec3f half_and_half(int x, int y) { return x < 80 ? smooth(x, y) : chequers(x, y); }

inline Splat draw(const Cloud& cloud, const Pose& pose = Pose::Identity()) {
  SplatOptions options;
  options.renormalise = true;
  return closed_splat(cloud, kCamera, pose, options);
}

/// dB, where the whole cloud hits.
inline double psnr_of(const Cloud& thin, const Cloud& whole, const Pose& pose = Pose::Identity()) {
  const Splat before = draw(whole, pose);
  return psnr(draw(thin, pose).color, before.color, before.hit);
}

}  // namespace ps
