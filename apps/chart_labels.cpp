// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_labels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "apps/chart_style.h"

namespace ps::apps {
namespace {

/// How many of some steps along a drawn line these words would hide.
int steps_hidden(const Drawing::Line& drawn, const cv::Rect2d& words) {
  constexpr int kSteps = 40;
  int hidden = 0;
  for (std::size_t i = 1; i < drawn.points.size(); ++i) {
    const cv::Point2d from = drawn.points[i - 1], way = drawn.points[i] - from;
    for (int s = 0; s <= kSteps; ++s) {
      hidden += words.contains(from + way * (s / static_cast<double>(kSteps))) ? 1 : 0;
    }
  }
  return hidden;
}

/// Where the corner of words may stand, seen from their dot.
std::vector<cv::Point2d> corners(double r, double width, double height) {
  return {{r, -r - height / 2},      {-r - width, -r - height / 2},
          {r, r - height / 2},       {-r - width, r - height / 2},
          {r, -height / 2},          {-r - width, -height / 2},
          {-width / 2, -r - height}, {-width / 2, r}};
}

class Placing {
 public:
  Placing(const cv::Rect2d& plot, std::vector<cv::Rect2d> taken, Drawing& drawing)
      : plot_(plot), taken_(std::move(taken)), drawing_(drawing) {}

  void add(const ChartLabel& label) {
    const double width = width_of(label.words, kWords) + 2, height = kWords;
    std::optional<cv::Rect2d> best;
    double least = 0;
    for (const double far : {0.0, 9.0, 20.0}) {
      for (const cv::Point2d& corner : corners(7 + far, width, height)) {
        const cv::Rect2d words(label.at + corner, cv::Size2d(width, height));
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

 private:
  /// How much of what is drawn already these words would hide.
  double hidden_by(const cv::Rect2d& words) const {
    double cost = 20 * (words.area() - (words & plot_).area());
    for (const cv::Rect2d& other : taken_) cost += 5 * (words & other).area();
    for (const Drawing::Line& drawn : drawing_.lines) {
      if (drawn.color != kGrid) cost += 8 * steps_hidden(drawn, words);
    }
    return cost;
  }

  /// A thin line to words that stand far from their dot.
  void add_leader(const cv::Point2d& dot, const cv::Rect2d& words) {
    constexpr double kNear = 24;
    const cv::Point2d end(std::clamp(dot.x, words.x, words.x + words.width),
                          std::clamp(dot.y, words.y, words.y + words.height));
    if (std::hypot(end.x - dot.x, end.y - dot.y) <= kNear) return;
    drawing_.lines.push_back({{dot, end}, kLeader, 0.8});
  }

  cv::Rect2d plot_;
  std::vector<cv::Rect2d> taken_;  ///< by words and dots
  Drawing& drawing_;
};

}  // namespace

void add_labels(const std::vector<ChartLabel>& labels, const cv::Rect2d& plot,
                std::vector<cv::Rect2d> taken, Drawing& drawing) {
  Placing placing(plot, std::move(taken), drawing);
  for (const ChartLabel& label : labels) placing.add(label);
}

}  // namespace ps::apps
