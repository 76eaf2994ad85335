// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "apps/chart_axis.h"
#include "apps/chart_labels.h"
#include "apps/chart_legend.h"
#include "apps/chart_style.h"
#include "apps/report.h"
#include "io/photo.h"
#include "libps/core/error.h"

namespace ps::apps {
namespace {

constexpr double kPng = 1.5;
constexpr double kAbove = 62, kBelow = 52, kRight = 20;  ///< the plot, pixels
constexpr double kLeastPlot = 30, kLegend = 46;
constexpr int kMostX = 9, kMostY = 8;  ///< ticks

void check(const ChartPicture& picture) {
  if (picture.width < 200 || picture.height < 150) {
    throw Error(
        "chart",
        "a picture of " + std::to_string(picture.width) + "x" + std::to_string(picture.height),
        "200x150 pixels at least");
  }
  for (const Curve& curve : picture.curves) {
    const std::size_t n = curve.x.size();
    const auto fits = [&](std::size_t size) { return size == 0 || size == n; };
    if (curve.y.size() != n || !fits(curve.low.size()) || !fits(curve.high.size()) ||
        !fits(curve.left.size()) || !fits(curve.right.size()) || !fits(curve.labels.size()) ||
        !fits(curve.links.size())) {
      throw Error("chart", "the curve '" + curve.name + "' has vectors of several lengths", "one");
    }
  }
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double value, bool above_zero) {
    if (!std::isfinite(value) || (above_zero && !(value > 0))) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const std::vector<double>& values, bool above_zero) {
    for (const double value : values) add(value, above_zero);
  }
  Axis axis(bool log, double from, double to) const {
    if (low > high) return log ? Axis(1, 10, true, from, to) : Axis(0, 1, false, from, to);
    return Axis(low, high, log, from, to);
  }
};

/// A chart being laid out.
class Layout {
 public:
  explicit Layout(const ChartPicture& picture);
  Drawing drawing() &&;

 private:
  void add_axes();
  void add_curve(const Curve& curve, unsigned color);
  void add_bars(const Curve& curve, std::size_t i, unsigned color);
  void add_marks();
  std::optional<cv::Point2d> place(double x, double y) const;
  void line(std::vector<cv::Point2d> points, unsigned color, double width, bool dashed = false) {
    drawing_.lines.push_back({std::move(points), color, width, dashed});
  }

  const ChartPicture& picture_;
  const Range y_range_;
  const double left_;  ///< of the plot, pixels
  const ChartLegend legend_;
  const cv::Rect2d plot_;  ///< pixels
  const Axis y_;
  const Axis x_;
  Drawing drawing_;
  std::vector<ChartLabel> labels_;
  std::vector<cv::Rect2d> taken_;  ///< by dots
};

Range x_range_of(const ChartPicture& picture) {
  Range range;
  for (const Curve& curve : picture.curves) {
    for (const auto* values : {&curve.x, &curve.left, &curve.right}) {
      range.add(*values, picture.log_x);
    }
  }
  for (const ChartMark& mark : picture.marked) range.add(mark.x, picture.log_x);
  return range;
}

Range y_range_of(const ChartPicture& picture) {
  Range range;
  for (const Curve& curve : picture.curves) {
    for (const auto* values : {&curve.y, &curve.low, &curve.high}) range.add(*values, false);
  }
  for (const ChartMark& mark : picture.marked) range.add(mark.y, false);
  return range;
}

/// Room for the words at the ticks and for the axis's name.
double left_of(const Range& y) {
  double widest = 0;
  for (const Tick& tick : y.axis(false, 1, 0).ticks(kMostY)) {  // the same wherever they stand
    widest = std::max(widest, width_of(tick.words, kWords));
  }
  return 36 + widest;
}

cv::Rect2d plot_of(const ChartPicture& picture, double left, const ChartLegend& legend) {
  const double above = kAbove + legend.more_height();
  const double width = picture.width - kRight - left, height = picture.height - kBelow - above;
  if (width < kLeastPlot || height < kLeastPlot) {
    throw Error("chart", "its words leave no room for the plot", "a larger picture");
  }
  return {left, above, width, height};
}

Layout::Layout(const ChartPicture& picture)
    : picture_(picture),
      y_range_(y_range_of(picture)),
      left_(left_of(y_range_)),
      legend_(picture, left_, picture.width - kRight),
      plot_(plot_of(picture, left_, legend_)),
      y_(y_range_.axis(false, plot_.y + plot_.height, plot_.y)),
      x_(x_range_of(picture).axis(picture.log_x, plot_.x, plot_.x + plot_.width)) {
  drawing_.width = picture.width;
  drawing_.height = picture.height;
}

std::optional<cv::Point2d> Layout::place(double x, double y) const {
  if (!x_.holds(x) || !y_.holds(y)) return {};
  return cv::Point2d(x_.at(x), y_.at(y));
}

void Layout::add_axes() {
  const double left = plot_.x, right = plot_.x + plot_.width, top = plot_.y,
               bottom = plot_.y + plot_.height;
  using Align = Drawing::Align;
  for (const Tick& tick : x_.ticks(kMostX)) {
    const double x = x_.at(tick.value);
    line({{x, top}, {x, bottom}}, kGrid, 1);
    drawing_.texts.push_back({{x, bottom + 18}, tick.words, kWords, Align::middle});
  }
  for (const Tick& tick : y_.ticks(kMostY)) {
    const double y = y_.at(tick.value);
    line({{left, y}, {right, y}}, kGrid, 1);
    drawing_.texts.push_back({{left - 7, y + 4.5}, tick.words, kWords, Align::end});
  }
  line({{left, top}, {left, bottom}, {right, bottom}}, kInk, 1.2);
  drawing_.texts.push_back({{left, 24}, picture_.title, kTitle, Align::start, false, true});
  drawing_.texts.push_back(
      {{left + plot_.width / 2, bottom + 40}, picture_.x_name, kWords, Align::middle});
  drawing_.texts.push_back(
      {{18, top + plot_.height / 2}, picture_.y_name, kWords, Align::middle, true});
}

void Layout::add_bars(const Curve& curve, std::size_t i, unsigned color) {
  constexpr double kCap = 3;
  const auto bar = [&](const std::optional<cv::Point2d>& a, const std::optional<cv::Point2d>& b,
                       const cv::Point2d& cap) {
    if (!a || !b) return;
    line({*a, *b}, color, 1.2);
    line({*a - cap, *a + cap}, color, 1.2);
    line({*b - cap, *b + cap}, color, 1.2);
  };
  const double x = curve.x[i], y = curve.y[i];
  if (!curve.low.empty() && !curve.high.empty()) {
    bar(place(x, curve.low[i]), place(x, curve.high[i]), {kCap, 0});
  }
  if (!curve.left.empty() && !curve.right.empty()) {
    bar(place(curve.left[i], y), place(curve.right[i], y), {0, kCap});
  }
}

void Layout::add_curve(const Curve& curve, unsigned color) {
  std::vector<cv::Point2d> run;
  const auto end_run = [&] {
    if (curve.line && run.size() > 1) line(run, color, 1.8, !curve.dots);
    run.clear();
  };
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const auto at = place(curve.x[i], curve.y[i]);
    if (!at) {
      end_run();
      continue;
    }
    run.push_back(*at);
    add_bars(curve, i, color);
    if (curve.dots) {
      drawing_.dots.push_back({*at, kDot, color, false, curve.links.empty() ? "" : curve.links[i]});
      taken_.emplace_back(at->x - kRing, at->y - kRing, 2 * kRing, 2 * kRing);
    }
    if (!curve.labels.empty()) labels_.push_back({*at, curve.labels[i]});
  }
  end_run();
}

void Layout::add_marks() {
  for (const ChartMark& mark : picture_.marked) {
    if (const auto at = place(mark.x, mark.y)) drawing_.dots.push_back({*at, kRing, kInk, true});
  }
}

Drawing Layout::drawing() && {
  add_axes();
  for (std::size_t c = 0; c < picture_.curves.size(); ++c) {
    add_curve(picture_.curves[c], color_of_curve(c));
  }
  add_labels(labels_, plot_, std::move(taken_), drawing_);
  add_marks();
  legend_.draw(kLegend, drawing_);
  return std::move(drawing_);
}

}  // namespace

Drawing drawing_of(const ChartPicture& picture) {
  check(picture);
  return Layout(picture).drawing();
}

Image chart_image(const ChartPicture& picture) { return picture_of(drawing_of(picture), kPng); }

void write_chart_png(const std::filesystem::path& path, const ChartPicture& picture) {
  write_image(path, chart_image(picture));
}

void write_chart_svg(const std::filesystem::path& path, const ChartPicture& picture) {
  write_text(path, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + svg_of(drawing_of(picture)));
}

}  // namespace ps::apps
