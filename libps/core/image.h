// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

namespace ps {

/// RGB in this channel order, float in [0,1], row-major; pixel centres are at integers.
using Image = cv::Mat3f;

/// Metres along the camera's z axis; 0 = unknown.
using Depth = cv::Mat1f;

/// 0 or 1 for each pixel.
using Mask = cv::Mat1b;

/// @return a colour in [0,1] as 0 to 255, rounded; what is outside is clamped, NaN is 0
inline std::uint8_t to_byte(float color) {
  return static_cast<std::uint8_t>(std::lround(std::fmin(std::fmax(color, 0.f), 1.f) * 255));
}

/// @return whether one size is the other, resized: sides may differ by a pixel's rounding, but the
/// aspects by 2 % at most, as a pixel is much of a small side
inline bool same_aspect(cv::Size a, cv::Size b) {
  const double across = static_cast<double>(a.width) * b.height;
  const double along = static_cast<double>(b.width) * a.height;
  const double difference = std::abs(across - along);
  return difference <= std::max<double>(a.width + a.height, b.width + b.height) &&
         difference <= 0.02 * std::max(across, along);
}

}  // namespace ps
