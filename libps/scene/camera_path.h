// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "libps/geometry/camera.h"

namespace ps {

/// @brief How far a camera turns and moves on a built-in path.
struct PathOptions {
  int frames = 64;
  double range_horizontal = 0.6;  ///< radians to either side (SPEC.md 2)
  double range_vertical = 0.3;    ///< radians up and down
  double orbit_radius = 0;        ///< metres; the camera also moves on a circle or line this wide
};

/// Names of the built-in paths: circle, sway, left, right, up, down, up-left, up-right, down-left,
/// down-right.
const std::vector<std::string>& path_names();

/// @brief Camera poses along a built-in path that starts at `start` (SPEC.md 2; the paper's
/// directions). `circle` turns once round an ellipse of the two ranges and ends where it started,
/// `sway` goes left, right and back; a direction goes from the start to its extreme (a diagonal has
/// half of each... see SPEC.md 2) evenly.
/// Throws ps::Error naming the choices when `name` is none of them, or when an option is unsound.
std::vector<Pose> camera_path(const std::string& name, const Pose& start,
                              const PathOptions& options = {});

}  // namespace ps
