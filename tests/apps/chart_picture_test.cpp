// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "apps/chart_axis.h"
#include "libps/core/error.h"

namespace ps::apps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<double> values_of(const std::vector<Tick>& ticks) {
  std::vector<double> values;
  for (const Tick& tick : ticks) values.push_back(tick.value);
  return values;
}

ChartPicture two_curves() {
  ChartPicture picture;
  picture.title = "a & b";
  picture.x_name = "seconds";
  picture.y_name = "dB";
  Curve bars = {"settings", {1, 2, 4}, {10, 12, 13}};
  bars.low = {9, 11, 12.5};
  bars.high = {11, 13, 13.5};
  bars.labels = {"one", "two", "four"};
  bars.links = {"#1", "#2", "#<4>"};
  bars.line = false;
  picture.curves = {bars, {"front", {1, 2, 4}, {10, 12, 13}}};
  picture.curves.back().dots = false;
  picture.marked = {{2, 12, "default"}};
  return picture;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

TEST(ChartAxis, ticks_are_round_and_on_the_axis) {
  const Axis axis(0, 10, false, 0, 100);
  EXPECT_EQ(values_of(axis.ticks(6)), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const Axis log(0.01, 10, true, 0, 100);
  EXPECT_EQ(values_of(log.ticks(4)), (std::vector<double>{0.01, 0.1, 1, 10}));
  for (const Tick& tick : Axis(-3.7, 1234, false, 50, 20).ticks(8)) {
    EXPECT_GE(Axis(-3.7, 1234, false, 50, 20).at(tick.value), 20);
    EXPECT_LE(Axis(-3.7, 1234, false, 50, 20).at(tick.value), 50);
  }
}

TEST(ChartAxis, equal_steps_of_a_logarithmic_axis_are_equal_ratios) {
  const Axis axis(1, 1000, true, 0, 300);
  EXPECT_NEAR(axis.at(100) - axis.at(10), axis.at(10) - axis.at(1), 1e-9);
  EXPECT_FALSE(axis.holds(0));
  EXPECT_FALSE(axis.holds(-5));
}

TEST(ChartAxis, of_one_value_or_of_many_powers_has_few_ticks) {
  EXPECT_TRUE(std::isfinite(Axis(3, 3, false, 0, 10).at(3)));
  EXPECT_TRUE(std::isfinite(Axis(0, 0, false, 0, 10).at(0)));
  EXPECT_TRUE(std::isfinite(Axis(3, 3, true, 0, 10).at(3)));
  EXPECT_LE(Axis(1e-30, 1e30, true, 0, 10).ticks(7).size(), 7u);
  EXPECT_GE(Axis(1e-30, 1e30, true, 0, 10).ticks(7).size(), 3u);
}

TEST(ChartPicture, puts_every_dot_bar_and_word_inside) {
  const ChartPicture picture = two_curves();
  const Drawing drawing = drawing_of(picture);
  EXPECT_EQ(drawing.dots.size(), 3u + 1u + 2u);  // of the curve, the ring, and the legend's
  for (const Drawing::Dot& dot : drawing.dots) {
    EXPECT_TRUE(cv::Rect2d(0, 0, picture.width, picture.height).contains(dot.at));
  }
  for (const char* words : {"one", "two", "four", "settings", "front", "default", "a & b", "dB"}) {
    EXPECT_EQ(std::count_if(drawing.texts.begin(), drawing.texts.end(),
                            [&](const Drawing::Text& text) { return text.words == words; }),
              1)
        << words;
  }
  // Greater values of y are higher up.
  EXPECT_LT(drawing.dots[2].at.y, drawing.dots[0].at.y);
  EXPECT_GT(drawing.dots[2].at.x, drawing.dots[0].at.x);
}

TEST(ChartPicture, leaves_out_what_is_not_finite_and_interrupts_the_line_there) {
  ChartPicture picture;
  picture.curves = {{"a", {1, 2, 3, 4, 5}, {1, 2, kNaN, 2, 1}}};
  const Drawing drawing = drawing_of(picture);
  EXPECT_EQ(drawing.dots.size(), 4u + 1u);
  EXPECT_EQ(std::count_if(drawing.lines.begin(), drawing.lines.end(),
                          [](const Drawing::Line& line) {
                            return line.color == 0x0072b2 && line.points.size() == 2 &&
                                   line.points[0].y != line.points[1].y;
                          }),
            2);
  picture.log_x = true;
  picture.curves = {{"a", {0, 1, 10}, {1, 2, 3}}};
  EXPECT_EQ(drawing_of(picture).dots.size(), 2u + 1u);
  picture.curves = {{"a", {kNaN}, {kNaN}}};
  EXPECT_EQ(drawing_of(picture).dots.size(), 0u + 1u);
  picture.curves = {};
  EXPECT_NO_THROW(drawing_of(picture));
}

TEST(ChartPicture, labels_of_dots_that_are_near_do_not_cover_each_other) {
  ChartPicture picture;
  Curve curve = {"", {1, 1.01, 1.02, 1.03, 5}, {1, 1.01, 1.02, 1.03, 5}};
  curve.labels = {"first", "second", "third", "fourth", "far"};
  picture.curves = {curve};
  const Drawing drawing = drawing_of(picture);
  std::vector<cv::Rect2d> places;
  for (const Drawing::Text& text : drawing.texts) {
    if (std::find(curve.labels.begin(), curve.labels.end(), text.words) == curve.labels.end()) {
      continue;
    }
    const cv::Rect2d place(text.at.x, text.at.y - 10, width_of(text.words, text.size), 12);
    for (const cv::Rect2d& other : places) EXPECT_EQ((place & other).area(), 0) << text.words;
    places.push_back(place);
  }
  EXPECT_EQ(places.size(), 5u);
}

/// As of a stress axis: many methods, and a limit whose name is a sentence.
ChartPicture many_curves() {
  ChartPicture picture;
  picture.x_name = "metres";
  picture.y_name = "PSNR of what is not seen, dB";
  for (const char* name :
       {"ours", "ours, without free space", "every frame outpainted in turn", "Poisson meshing",
        "nothing outpainted, the refiner fills in", "Navier-Stokes inpainting of every view",
        "truncated signed distances", "broken where PSNR of what is not seen is under 20 dB"}) {
    const double y = static_cast<double>(picture.curves.size());
    picture.curves.push_back({name, {1, 2, 3}, {y, y + 1, y}});
  }
  picture.curves.back().dots = false;
  return picture;
}

/// Where words of the legend are: those between the title and the plot.
std::vector<cv::Rect2d> legend_of(const Drawing& drawing, const ChartPicture& picture) {
  std::vector<cv::Rect2d> places;
  for (const Drawing::Text& text : drawing.texts) {
    const bool named = std::any_of(picture.curves.begin(), picture.curves.end(),
                                   [&](const Curve& c) { return c.name == text.words; });
    if (!named && text.words.find("...") == std::string::npos) continue;
    places.emplace_back(text.at.x, text.at.y - 10, width_of(text.words, text.size), 12);
  }
  return places;
}

TEST(ChartPicture, legends_of_many_curves_wrap_above_the_plot_and_end_inside) {
  const ChartPicture picture = many_curves();
  const Drawing drawing = drawing_of(picture);
  const std::vector<cv::Rect2d> places = legend_of(drawing, picture);
  ASSERT_EQ(places.size(), 8u);
  double highest_dot = picture.height, lowest_words = 0;
  for (const Drawing::Line& line : drawing.lines) {
    if (line.points.size() == 3 && line.color != 0x222222) {
      for (const cv::Point2d& p : line.points) highest_dot = std::min(highest_dot, p.y);
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_LE(places[i].br().x, picture.width) << i;
    lowest_words = std::max(lowest_words, places[i].br().y);
    for (std::size_t j = 0; j < i; ++j) EXPECT_EQ((places[i] & places[j]).area(), 0) << i;
  }
  EXPECT_GT(lowest_words, places.front().br().y);
  EXPECT_LT(lowest_words, highest_dot);
  std::set<unsigned> colors;
  for (const Drawing::Line& line : drawing.lines) {
    if (line.points.size() == 3 && line.color != 0x222222) colors.insert(line.color);
  }
  EXPECT_EQ(colors.size(), 8u);
}

TEST(ChartPicture, names_wider_than_a_line_are_shortened_and_words_must_leave_room) {
  ChartPicture picture = many_curves();
  picture.curves[3].name = std::string(200, 'w');
  const Drawing drawing = drawing_of(picture);
  const std::vector<cv::Rect2d> places = legend_of(drawing, picture);
  ASSERT_EQ(places.size(), 8u);
  for (const cv::Rect2d& place : places) EXPECT_LE(place.br().x, picture.width);
  picture.width = 200;
  picture.height = 150;
  EXPECT_THROW(drawing_of(picture), Error);
}

TEST(ChartPicture, refuses_vectors_of_several_lengths_and_tiny_pictures) {
  ChartPicture picture = two_curves();
  picture.curves[0].low.pop_back();
  EXPECT_THROW(drawing_of(picture), Error);
  picture = two_curves();
  picture.curves[1].y.pop_back();
  EXPECT_THROW(drawing_of(picture), Error);
  picture = two_curves();
  picture.width = 40;
  EXPECT_THROW(drawing_of(picture), Error);
}

TEST(ChartPicture, is_svg_whose_words_are_only_words) {
  const std::string svg = svg_of(drawing_of(two_curves()));
  EXPECT_EQ(count(svg, "<svg "), 1u);
  EXPECT_EQ(count(svg, "</svg>"), 1u);
  EXPECT_EQ(count(svg, "a &amp; b"), 1u);
  EXPECT_EQ(count(svg, "<a href="), 3u);
  EXPECT_EQ(count(svg, "#&lt;4&gt;"), 1u);
  EXPECT_EQ(count(svg, "<4>"), 0u);
  EXPECT_EQ(count(svg, "nan"), 0u);
}

}  // namespace
}  // namespace ps::apps
