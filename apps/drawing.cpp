// SPDX-License-Identifier: BSD-3-Clause
#include "apps/drawing.h"

#include <cmath>
#include <cstdio>

#include "apps/part.h"
#include "libps/core/words.h"

namespace ps::apps {
namespace {

std::string number(double value) { return in_digits(std::round(value * 100) / 100); }

std::string color_of(unsigned color) {
  char text[16];
  std::snprintf(text, sizeof text, "#%06x", color);
  return text;
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

std::string svg_of(const Drawing::Line& line) {
  std::string points;
  for (const cv::Point2d& p : line.points) {
    points += (points.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
  }
  return "<polyline fill=\"none\"" + attribute("stroke", color_of(line.color)) +
         attribute("stroke-width", number(line.width)) +
         (line.dashed ? attribute("stroke-dasharray", "6 4") : "") + attribute("points", points) +
         "/>\n";
}

std::string svg_of(const Drawing::Dot& dot) {
  const std::string circle =
      "<circle" + attribute("cx", number(dot.at.x)) + attribute("cy", number(dot.at.y)) +
      attribute("r", number(dot.radius)) + attribute("stroke", color_of(dot.color)) +
      attribute("stroke-width", "2") +
      attribute("fill", dot.hollow ? "none" : color_of(dot.color)) + "/>";
  if (dot.link.empty()) return circle + "\n";
  return "<a" + attribute("href", escaped(dot.link)) + ">" + circle + "</a>\n";
}

std::string svg_of(const Drawing::Text& text) {
  constexpr const char* kAnchors[] = {"start", "middle", "end"};
  const std::string x = number(text.at.x), y = number(text.at.y);
  return "<text" + attribute("x", x) + attribute("y", y) +
         attribute("font-size", number(text.size)) + attribute("fill", color_of(text.color)) +
         attribute("text-anchor", kAnchors[static_cast<int>(text.align)]) +
         (text.bold ? attribute("font-weight", "bold") : "") +
         (text.upwards ? attribute("transform", "rotate(-90 " + x + " " + y + ")") : "") + ">" +
         escaped(text.words) + "</text>\n";
}

}  // namespace

double width_of(const std::string& words, double size) {
  return 0.54 * size * static_cast<double>(words.size());
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string svg_of(const Drawing& drawing) {
  const std::string width = std::to_string(drawing.width), height = std::to_string(drawing.height);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", width) +
                    attribute("height", height) +
                    attribute("viewBox", "0 0 " + width + " " + height) +
                    attribute("font-family", "Arial, Liberation Sans, sans-serif") + ">\n" +
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (const Drawing::Line& line : drawing.lines) svg += svg_of(line);
  for (const Drawing::Dot& dot : drawing.dots) svg += svg_of(dot);
  for (const Drawing::Text& text : drawing.texts) svg += svg_of(text);
  return svg + "</svg>\n";
}

Image picture_of(const Drawing& drawing, double scale) {
  Image picture;
  function_of_part<decltype(pixelsynth_draw)>("viewer", "pixelsynth_draw")(drawing, scale,
                                                                           &picture);
  return picture;
}

}  // namespace ps::apps
