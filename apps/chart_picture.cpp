// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "apps/chart_axis.h"
#include "apps/report.h"
#include "io/photo.h"
#include "libps/core/error.h"

namespace ps::apps {
namespace {

/// Okabe and Ito's colours, which colour-blind people can tell apart.
constexpr unsigned kColors[] = {0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9};
constexpr unsigned kInk = 0x222222, kGrid = 0xe4e4e4, kLeader = 0x888888;
constexpr double kWords = 13, kTitle = 16, kPng = 1.5, kRing = 8;
constexpr double kAbove = 62, kBelow = 52;  ///< the plot, pixels
constexpr int kMostX = 9, kMostY = 8;       ///< ticks

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
  void add_labels();
  void add_leader(const cv::Point2d& dot, const cv::Rect2d& words);
  void add_legend();
  std::optional<cv::Point2d> place(double x, double y) const;
  void line(std::vector<cv::Point2d> points, unsigned color, double width, bool dashed = false) {
    drawing_.lines.push_back({std::move(points), color, width, dashed});
  }
  double hidden_by(const cv::Rect2d& words) const;

  struct Label {
    cv::Point2d at;
    std::string words;
  };

  const ChartPicture& picture_;
  const Axis y_;
  const cv::Rect2d plot_;  ///< pixels
  const Axis x_;
  Drawing drawing_;
  std::vector<Label> labels_;
  std::vector<cv::Rect2d> taken_;  ///< by words and dots
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
double left_of(const Axis& y) {
  double widest = 0;
  for (const Tick& tick : y.ticks(kMostY)) widest = std::max(widest, width_of(tick.words, kWords));
  return 36 + widest;
}

Layout::Layout(const ChartPicture& picture)
    : picture_(picture),
      y_(y_range_of(picture).axis(false, picture.height - kBelow, kAbove)),
      plot_(cv::Point2d(left_of(y_), kAbove),
            cv::Point2d(picture.width - 20, picture.height - kBelow)),
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
  constexpr double kRadius = 4;
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
      drawing_.dots.push_back(
          {*at, kRadius, color, false, curve.links.empty() ? "" : curve.links[i]});
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

/// How much of what is drawn already these words would hide.
double Layout::hidden_by(const cv::Rect2d& words) const {
  double cost = 0;
  const cv::Rect2d inside = words & plot_;
  cost += 20 * (words.area() - inside.area());
  for (const cv::Rect2d& other : taken_) cost += 5 * (words & other).area();
  for (const Drawing::Line& drawn : drawing_.lines) {
    if (drawn.color == kGrid) continue;
    for (std::size_t i = 1; i < drawn.points.size(); ++i) {
      constexpr int kSteps = 40;
      for (int s = 0; s <= kSteps; ++s) {
        const cv::Point2d p =
            drawn.points[i - 1] + (drawn.points[i] - drawn.points[i - 1]) * (s / double(kSteps));
        cost += words.contains(p) ? 8 : 0;
      }
    }
  }
  return cost;
}

/// A thin line to words that stand far from their dot.
void Layout::add_leader(const cv::Point2d& dot, const cv::Rect2d& words) {
  constexpr double kNear = 24;
  const cv::Point2d end(std::clamp(dot.x, words.x, words.x + words.width),
                        std::clamp(dot.y, words.y, words.y + words.height));
  if (std::hypot(end.x - dot.x, end.y - dot.y) > kNear) line({dot, end}, kLeader, 0.8);
}

void Layout::add_labels() {
  for (const Label& label : labels_) {
    const double width = width_of(label.words, kWords) + 2, height = kWords;
    std::optional<cv::Rect2d> best;
    double least = 0;
    for (const double far : {0.0, 9.0, 20.0}) {
      const double r = 7 + far;
      for (const cv::Point2d& corner :
           {cv::Point2d(r, -r - height / 2), cv::Point2d(-r - width, -r - height / 2),
            cv::Point2d(r, r - height / 2), cv::Point2d(-r - width, r - height / 2),
            cv::Point2d(r, -height / 2), cv::Point2d(-r - width, -height / 2),
            cv::Point2d(-width / 2, -r - height), cv::Point2d(-width / 2, r)}) {
        const cv::Rect2d words(label.at.x + corner.x, label.at.y + corner.y, width, height);
        const double cost = hidden_by(words) + far;
        if (!best || cost < least) {
          best = words;
          least = cost;
        }
      }
    }
    taken_.push_back(*best);
    add_leader(label.at, *best);
    drawing_.texts.push_back({{best->x + 1, best->y + height - 2}, label.words, kWords});
  }
}

/// One line of the legend, between the title and the plot.
void Layout::add_legend() {
  double x = plot_.x;
  const double y = 46;
  const auto words = [&](const std::string& name) {
    drawing_.texts.push_back({{x + 30, y + 4.5}, name, kWords});
    x += 30 + width_of(name, kWords) + 16;
  };
  std::size_t c = 0;
  for (const Curve& curve : picture_.curves) {
    const unsigned color = kColors[c++ % std::size(kColors)];
    if (curve.name.empty()) continue;
    if (curve.line) line({{x, y}, {x + 24, y}}, color, 1.8, !curve.dots);
    if (curve.dots) drawing_.dots.push_back({{x + 12, y}, 4, color});
    words(curve.name);
  }
  std::set<std::string> named;
  for (const ChartMark& mark : picture_.marked) {
    if (mark.name.empty() || !named.insert(mark.name).second) continue;
    drawing_.dots.push_back({{x + 12, y}, kRing, kInk, true});
    words(mark.name);
  }
}

Drawing Layout::drawing() && {
  add_axes();
  std::size_t c = 0;
  for (const Curve& curve : picture_.curves) add_curve(curve, kColors[c++ % std::size(kColors)]);
  add_labels();
  add_marks();
  add_legend();
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
