// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_legend.h"

#include <set>
#include <utility>

#include "apps/chart_style.h"

namespace ps::apps {
namespace {

constexpr double kKey = 24, kIndent = 30, kApart = 16, kRow = 20;  ///< pixels

/// @return the text, or as much of it as is not wider than this
std::string shortened(std::string text, double width) {
  const auto fits = [&](const std::string& words) { return width_of(words, kWords) <= width; };
  if (fits(text)) return text;
  const auto ends_within_letter = [&] { return (text.back() & 0xc0) == 0x80; };  // UTF-8
  while (!text.empty() && !fits(text + "...")) {
    while (text.size() > 1 && ends_within_letter()) text.pop_back();
    text.pop_back();
  }
  return text + "...";
}

}  // namespace

ChartLegend::ChartLegend(const ChartPicture& picture, double left, double right)
    : left_(left), right_(right), end_(left) {
  for (std::size_t c = 0; c < picture.curves.size(); ++c) {
    const Curve& curve = picture.curves[c];
    if (curve.name.empty()) continue;
    add({curve.name, color_of_curve(c), curve.line, curve.dots, false, !curve.dots});
  }
  std::set<std::string> named;
  for (const ChartMark& mark : picture.marked) {
    if (mark.name.empty() || !named.insert(mark.name).second) continue;
    add({mark.name, kInk, false, false, true});
  }
}

void ChartLegend::add(Entry entry) {
  entry.name = shortened(std::move(entry.name), right_ - left_ - kIndent);
  const double width = kIndent + width_of(entry.name, kWords);
  if (end_ > left_ && end_ + width > right_) {
    ++row_;
    end_ = left_;
  }
  entry.x = end_;
  entry.row = row_;
  end_ += width + kApart;
  entries_.push_back(std::move(entry));
}

double ChartLegend::more_height() const { return row_ * kRow; }

void ChartLegend::draw(double first, Drawing& drawing) const {
  for (const Entry& entry : entries_) {
    const double x = entry.x, y = first + entry.row * kRow;
    if (entry.line)
      drawing.lines.push_back({{{x, y}, {x + kKey, y}}, entry.color, 1.8, entry.dashed});
    if (entry.dot) drawing.dots.push_back({{x + kKey / 2, y}, kDot, entry.color});
    if (entry.ring) drawing.dots.push_back({{x + kKey / 2, y}, kRing, entry.color, true});
    drawing.texts.push_back({{x + kIndent, y + 4.5}, entry.name, kWords});
  }
}

}  // namespace ps::apps
