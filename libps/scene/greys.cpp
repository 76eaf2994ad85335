// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/greys.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "libps/geometry/point.h"

namespace ps {

bool is_grey(const Cloud& cloud) {
  constexpr int kLevels = 2;
  return !cloud.empty() && std::all_of(cloud.begin(), cloud.end(), [](const Point& p) {
    const auto [least, most] = std::minmax({int{p.r}, int{p.g}, int{p.b}});
    return most - least <= kLevels;
  });
}

Image grey_of(const Image& image) {
  cv::Mat1f luma;
  cv::cvtColor(image, luma, cv::COLOR_RGB2GRAY);
  Image grey;
  cv::cvtColor(luma, grey, cv::COLOR_GRAY2RGB);
  return grey;
}

}  // namespace ps
