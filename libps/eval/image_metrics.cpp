// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/image_metrics.h"

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>

#include "libps/core/error.h"

namespace ps {
namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

void check_sizes(const Image& a, const Image& b, const Mask& where, const char* metric) {
  const auto text = [](const cv::Size& size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
  };
  if (b.size() != a.size()) {
    throw Error(metric, "the second image has " + text(b.size()) + " pixels", text(a.size()));
  }
  if (!where.empty() && where.size() != a.size()) {
    throw Error(metric, "the mask has " + text(where.size()) + " pixels", text(a.size()));
  }
}

double mean_or_nan(double sum, std::size_t count) {
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

cv::Mat1d grey(const Image& image) {
  cv::Mat1d out(image.size());
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3f& rgb = image(y, x);
      out(y, x) = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
    }
  }
  return out;
}

cv::Mat1d window_mean(const cv::Mat1d& values) {
  cv::Mat1d out;
  cv::GaussianBlur(values, out, {kWindow, kWindow}, kSigma, kSigma);
  return out;
}

}  // namespace

double psnr(const Image& a, const Image& b, const Mask& where) {
  check_sizes(a, b, where, "psnr");
  double sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) {
      if (!where.empty() && where(y, x) == 0) continue;
      for (int c = 0; c < 3; ++c) {
        const double difference = static_cast<double>(a(y, x)[c]) - b(y, x)[c];
        sum += difference * difference;
      }
      count += 3;
    }
  }
  return -10 * std::log10(mean_or_nan(sum, count));
}

double ssim(const Image& a, const Image& b, const Mask& where) {
  check_sizes(a, b, where, "ssim");
  if (a.empty()) return std::numeric_limits<double>::quiet_NaN();
  const cv::Mat1d x = grey(a);
  const cv::Mat1d y = grey(b);
  const cv::Mat1d mean_x = window_mean(x);
  const cv::Mat1d mean_y = window_mean(y);
  const cv::Mat1d mean_xx = window_mean(x.mul(x));
  const cv::Mat1d mean_yy = window_mean(y.mul(y));
  const cv::Mat1d mean_xy = window_mean(x.mul(y));

  constexpr int margin = kWindow / 2;
  double sum = 0;
  std::size_t count = 0;
  for (int v = margin; v < a.rows - margin; ++v) {
    for (int u = margin; u < a.cols - margin; ++u) {
      if (!where.empty() && where(v, u) == 0) continue;
      const double mx = mean_x(v, u);
      const double my = mean_y(v, u);
      const double luminance = (2 * mx * my + kC1) / (mx * mx + my * my + kC1);
      const double variances = mean_xx(v, u) - mx * mx + mean_yy(v, u) - my * my;
      sum += luminance * (2 * (mean_xy(v, u) - mx * my) + kC2) / (variances + kC2);
      ++count;
    }
  }
  return mean_or_nan(sum, count);
}

}  // namespace ps
