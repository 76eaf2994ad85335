// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/seam_colors.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "libps/core/error.h"
#include "libps/geometry/membrane.h"

namespace ps {
namespace {

/// Means of a picture around each pixel, of the pixels where the mask is 1.
struct Means {
  Image color;
  cv::Mat1f count;  ///< of pixels, of one; 0 = none

  Means(const Image& picture, const cv::Mat1f& mask, int reach) {
    const cv::Size window(2 * reach + 1, 2 * reach + 1);
    const auto sums = [&](const cv::Mat& of, const cv::Mat& to) {
      cv::boxFilter(of, to, -1, window, cv::Point(-1, -1), false, cv::BORDER_CONSTANT);
    };
    count.create(mask.size());
    color.create(mask.size());
    Image masked(picture.size());
    for (int i = 0; i < static_cast<int>(mask.total()); ++i) {
      const int y = i / mask.cols, x = i % mask.cols;
      masked(y, x) = mask(y, x) > 0 ? picture(y, x) : cv::Vec3f();
    }
    sums(mask, count);
    sums(masked, color);
  }

  bool any(int y, int x) const { return count(y, x) > 0.5f; }
  cv::Vec3f mean(int y, int x) const { return color(y, x) / count(y, x); }
};

void check(const Image& seen, const Image& painted, const Mask& missing,
           const SeamColorOptions& options) {
  if (seen.empty() || seen.size() != painted.size() || seen.size() != missing.size()) {
    throw Error("continue_colors", "pictures and mask differ in size or are empty", "one size");
  }
  if (!(options.decay > 0) || options.reach < 1 || !(options.edge > 0)) {
    throw Error("continue_colors", "an option is out of range",
                "decay > 0, reach >= 1 and edge > 0");
  }
}

}  // namespace

Image continue_colors(const Image& seen, const Image& painted, const Mask& missing,
                      const SeamColorOptions& options) {
  check(seen, painted, missing, options);
  cv::Mat1f outside, inside;
  cv::Mat(missing == 0).convertTo(outside, CV_32F, 1.0 / 255);
  inside = 1 - outside;
  const Means before(seen, outside, options.reach), beyond(painted, inside, options.reach);
  const auto loose = static_cast<float>(1 / (options.decay * options.decay));
  cv::Mat1f weight(seen.size(), loose);
  std::vector<cv::Mat1f> steps(3);
  for (cv::Mat1f& step : steps) step = cv::Mat1f::zeros(seen.size());
  for (int y = 0; y < seen.rows; ++y) {
    for (int x = 0; x < seen.cols; ++x) {
      if (!before.any(y, x) || !beyond.any(y, x)) continue;
      const cv::Vec3f step = before.mean(y, x) - beyond.mean(y, x);
      const double edges = cv::norm(step) / options.edge;
      const auto trust = static_cast<float>(1 / (1 + std::pow(edges, 4)));
      weight(y, x) = 1;
      for (int c = 0; c < 3; ++c) steps[static_cast<std::size_t>(c)](y, x) = trust * step[c];
    }
  }
  for (cv::Mat1f& step : steps) step = solve_membrane(step, weight);
  Image out = painted.clone();
  for (int y = 0; y < out.rows; ++y) {
    for (int x = 0; x < out.cols; ++x) {
      if (!missing(y, x)) continue;
      for (int c = 0; c < 3; ++c) {
        float& value = out(y, x)[c];
        value = std::clamp(value + steps[static_cast<std::size_t>(c)](y, x), 0.f, 1.f);
      }
    }
  }
  return out;
}

}  // namespace ps
