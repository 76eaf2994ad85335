// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/drawing.h"
#include "libps/core/image.h"

namespace ps::apps {

/// @brief Dots in a chart, joined by a line in their order. What is not finite is left out, and
/// interrupts the line. Vectors are as long as `x`, or empty.
struct Curve {
  std::string name;                           ///< in the legend; empty = not in it
  std::vector<double> x, y;                   ///< dots
  std::vector<double> low = {}, high = {};    ///< error bars: values of y, not lengths
  std::vector<double> left = {}, right = {};  ///< and of x
  std::vector<std::string> labels = {};       ///< beside dots
  std::vector<std::string> links = {};        ///< where clicks on dots lead, in SVG
  bool line = true, dots = true;
};

/// A place that a chart has a ring at; `name` in the legend. Rings of one name come once there.
struct ChartMark {
  double x = 0, y = 0;
  std::string name;
};

struct ChartPicture {
  std::string title, x_name, y_name;
  bool log_x = false;  ///< then x that are not above 0 are left out
  std::vector<Curve> curves;
  std::vector<ChartMark> marked = {};
  int width = 720, height = 480;  ///< pixels of the SVG; a PNG has half as many again
};

/// @brief Lays a chart out: axes with round numbers around all that is finite, a legend of as many
/// lines as it takes, labels where they hide least. Nine curves have colours of their own. Throws
/// ps::Error when a curve's vectors differ in length, or the picture
/// is too small for its words.
Drawing drawing_of(const ChartPicture& picture);

/// @brief Draws with VTK, off screen. Needs a Display (display.h). Throws ps::Error as drawing_of()
/// does and when there is no OpenGL.
Image chart_image(const ChartPicture& picture);

/// @brief The same as files, whole or not at all; SVG needs no Display. Throws ps::Error.
void write_chart_png(const std::filesystem::path& path, const ChartPicture& picture);
void write_chart_svg(const std::filesystem::path& path, const ChartPicture& picture);

}  // namespace ps::apps
