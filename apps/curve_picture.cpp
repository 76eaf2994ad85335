// SPDX-License-Identifier: BSD-3-Clause
#include "apps/curve_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace ps::apps {
namespace {

constexpr int kWidth = 720, kHeight = 420;
const cv::Rect kPlot(64, 40, 450, 320);
const std::array<cv::Scalar, 8> kColors = {cv::Scalar(.80, .15, .15), cv::Scalar(.95, .60, .20),
                                           cv::Scalar(.15, .35, .75), cv::Scalar(.15, .60, .30),
                                           cv::Scalar(.55, .30, .65), cv::Scalar(.30, .65, .70),
                                           cv::Scalar(.50, .50, .50), cv::Scalar(.45, .30, .15)};
const cv::Scalar kInk(.1, .1, .1), kPale(.85, .85, .85);

void put(Image& image, const std::string& text, cv::Point at, double size = .42) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Where values fall in the plot.
struct Scale {
  double low, high;
  std::size_t count;

  explicit Scale(const CurveChart& chart)
      : low(chart.limit), high(chart.limit), count(chart.x.size()) {
    for (const PlottedCurve& curve : chart.curves) {
      for (const double y : curve.y) {
        if (!std::isfinite(y)) continue;
        low = std::min(low, y);
        high = std::max(high, y);
      }
    }
    const double margin = std::max(1e-9, .05 * (high - low));
    low -= margin;
    high += margin;
  }

  int x(std::size_t i) const {
    const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : .5;
    return kPlot.x + static_cast<int>(std::lround(share * kPlot.width));
  }
  int y(double value) const {
    const double share = (high - value) / (high - low);
    return kPlot.y + static_cast<int>(std::lround(share * kPlot.height));
  }
};

void draw_axes(Image& image, const CurveChart& chart, const Scale& scale) {
  const int bottom = kPlot.y + kPlot.height, right = kPlot.x + kPlot.width;
  for (int k = 0; k <= 5; ++k) {
    const double value = scale.low + (scale.high - scale.low) * k / 5;
    const int y = scale.y(value);
    cv::line(image, {kPlot.x, y}, {right, y}, kPale);
    put(image, number(value), {8, y + 4});
  }
  for (std::size_t i = 0; i < chart.x.size(); ++i) {
    cv::line(image, {scale.x(i), kPlot.y}, {scale.x(i), bottom}, kPale);
    put(image, number(chart.x[i]), {scale.x(i) - 10, bottom + 18}, .36);
  }
  cv::rectangle(image, kPlot, kInk);
  put(image, chart.title, {kPlot.x, 24}, .5);
  put(image, chart.x_label, {kPlot.x + 90, bottom + 42});
  put(image, chart.y_label, {8, kPlot.y - 18}, .38);
  const int limit = scale.y(chart.limit);
  for (int x = kPlot.x; x < right; x += 10) cv::line(image, {x, limit}, {x + 5, limit}, kInk);
}

void draw_curve(Image& image, const PlottedCurve& curve, const Scale& scale, std::size_t index) {
  const cv::Scalar color = kColors[index % kColors.size()];
  const int thickness = index == 0 ? 2 : 1;
  for (std::size_t i = 0; i < curve.y.size(); ++i) {
    if (!std::isfinite(curve.y[i])) continue;
    const cv::Point here(scale.x(i), scale.y(curve.y[i]));
    cv::circle(image, here, 3, color, cv::FILLED, cv::LINE_AA);
    if (i == 0 || !std::isfinite(curve.y[i - 1])) continue;
    cv::line(image, {scale.x(i - 1), scale.y(curve.y[i - 1])}, here, color, thickness, cv::LINE_AA);
  }
  const cv::Point key(kPlot.x + kPlot.width + 14, kPlot.y + 14 + 20 * static_cast<int>(index));
  cv::line(image, key, key + cv::Point(18, 0), color, thickness + 1, cv::LINE_AA);
  put(image, curve.name, key + cv::Point(24, 4));
}

}  // namespace

Image curve_picture(const CurveChart& chart) {
  Image image(kHeight, kWidth, cv::Vec3f(1, 1, 1));
  const Scale scale(chart);
  draw_axes(image, chart, scale);
  for (std::size_t i = chart.curves.size(); i-- > 0;) draw_curve(image, chart.curves[i], scale, i);
  return image;
}

}  // namespace ps::apps
