// SPDX-License-Identifier: BSD-3-Clause
#include "apps/point_colors.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace ps::apps {
namespace {

float distance(const Point& point, const Eigen::Vector3f& from) {
  return (point.getVector3fMap() - from).norm();
}

/// @return the distance that the share `rank` of the points is nearer than
float distance_at(const Cloud& cloud, const Eigen::Vector3f& from, double rank) {
  constexpr std::size_t kSamples = 100000;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSamples);
  std::vector<float> distances;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    distances.push_back(distance(cloud[i], from));
  }
  const auto nth = distances.begin() +
                   static_cast<std::ptrdiff_t>(rank * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), nth, distances.end());
  return *nth;
}

std::array<Rgb, 256> turbo() {
  cv::Mat1b ramp(1, 256);
  for (int i = 0; i < 256; ++i) ramp(0, i) = static_cast<std::uint8_t>(i);
  cv::Mat3b bgr;
  cv::applyColorMap(ramp, bgr, cv::COLORMAP_TURBO);
  std::array<Rgb, 256> colors;
  for (int i = 0; i < 256; ++i) {
    const cv::Vec3b c = bgr(0, i);
    colors[static_cast<std::size_t>(i)] = {c[2], c[1], c[0]};
  }
  return colors;
}

std::vector<Rgb> by_depth(const Cloud& cloud, const Pose& from) {
  const std::array<Rgb, 256> ramp = turbo();
  const Eigen::Vector3f center = from.translation().cast<float>();
  const float near = distance_at(cloud, center, 0.02), far = distance_at(cloud, center, 0.98);
  std::vector<Rgb> colors;
  colors.reserve(cloud.size());
  for (const Point& point : cloud) {
    const float share = (far - distance(point, center)) / std::max(far - near, 1e-6f);
    colors.push_back(ramp[static_cast<std::size_t>(255 * std::clamp(share, 0.0f, 1.0f))]);
  }
  return colors;
}

/// Neighbouring numbers get colours far apart: hues a golden angle from one another.
Rgb color_of_view(std::uint16_t view) {
  const double hue = std::fmod(view * 0.61803398875, 1.0) * 6;
  const auto channel = [&](double shift) {
    const double ramp = std::abs(std::fmod(hue + shift, 6.0) - 3) - 1;
    return static_cast<std::uint8_t>(60 + 180 * std::clamp(ramp, 0.0, 1.0));
  };
  return {channel(0), channel(4), channel(2)};
}

}  // namespace

const std::vector<std::string>& color_names() {
  static const std::vector<std::string> names = {"photo", "depth", "view", "origin"};
  return names;
}

std::vector<Rgb> point_colors(const Cloud& cloud, ColorBy by, const Pose& from) {
  if (by == ColorBy::depth && !cloud.empty()) return by_depth(cloud, from);
  constexpr Rgb kOutpainted = {255, 140, 0};
  std::vector<Rgb> colors;
  colors.reserve(cloud.size());
  for (const Point& point : cloud) {
    const bool outpainted = point.origin == static_cast<std::uint8_t>(Origin::outpainted);
    if (by == ColorBy::view) {
      colors.push_back(color_of_view(point.view));
    } else if (by == ColorBy::origin && outpainted) {
      colors.push_back(kOutpainted);
    } else {
      colors.push_back({point.r, point.g, point.b});
    }
  }
  return colors;
}

double median_distance(const Cloud& cloud, const Pose& from) {
  if (cloud.empty()) return 1;
  return std::max(1e-3f, distance_at(cloud, from.translation().cast<float>(), 0.5));
}

}  // namespace ps::apps
