// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/point_colors.h"
#include "libps/core/image.h"

namespace ps::apps {

/// What the viewer shows at first; keys change it.
struct ViewerOptions {
  cv::Size size = {1024, 768};
  std::string title = "pixelsynth";
  ColorBy color_by = ColorBy::photo;
  double point_size = 3;  ///< pixels
  bool axes = true;
  bool cameras = true;
  Intrinsics lens;                ///< of the start and of the cameras drawn
  Pose start = Pose::Identity();  ///< where one looks from; y down is drawn downwards
  std::vector<Pose> trajectory;   ///< drawn as frusta, but for those that the start would sit in
};

/// @brief Opens a window and returns when the user closes it. Needs a Display.
/// Throws ps::Error when the cloud is empty or the display has no OpenGL 3.2.
void show(const Cloud& cloud, const ViewerOptions& options);

/// @brief What the window would show at first but for its words, without one. Needs a Display;
/// throws as show() does.
Image snapshot(const Cloud& cloud, const ViewerOptions& options);

/// What these two call, in the part `viewer` of the program (part.h).
extern "C" {
void pixelsynth_show(const Cloud& cloud, const ViewerOptions& options);
void pixelsynth_snapshot(const Cloud& cloud, const ViewerOptions& options, Image* picture);
}

}  // namespace ps::apps
