// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "libps/core/image.h"

namespace ps::apps {

/// @brief Lines, then dots, then words on white; pixels, y down. Colours are 0xRRGGBB.
struct Drawing {
  struct Line {
    std::vector<cv::Point2d> points;
    unsigned color = 0;
    double width = 1;
    bool dashed = false;
  };
  struct Dot {
    cv::Point2d at;
    double radius = 3;
    unsigned color = 0;
    bool hollow = false;
    std::string link = {};  ///< an address; empty = none
  };
  enum class Align { start, middle, end };
  struct Text {
    cv::Point2d at;  ///< on the line that the letters stand on
    std::string words;
    double size = 13;
    Align align = Align::start;
    bool upwards = false;  ///< written from below to above
    bool bold = false;
    unsigned color = 0x222222;
  };

  int width = 0, height = 0;
  std::vector<Line> lines;
  std::vector<Dot> dots;
  std::vector<Text> texts;
};

/// @return about how wide these words are, pixels
double width_of(const std::string& words, double size);

/// @return the text with what XML and HTML would take for more than text written in another way
std::string escaped(const std::string& text);

/// @return an <svg> element
std::string svg_of(const Drawing& drawing);

/// @brief Draws with VTK, off screen, `scale` pixels for one. Needs a Display (display.h). Throws
/// ps::Error when it has no OpenGL.
Image picture_of(const Drawing& drawing, double scale);

/// What this calls, in the part `viewer` of the program (part.h).
extern "C" void pixelsynth_draw(const Drawing& drawing, double scale, Image* picture);

}  // namespace ps::apps
