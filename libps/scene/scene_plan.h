// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "libps/scene/camera_path.h"

namespace ps {

/// @brief How a scene's views come to agree, or not (PixelSynth, section 4.3).
enum class Strategy {
  support,      ///< outpaint at the extremes, accumulate, splat every view in between
  sequential,   ///< outpaint in every view, the nearest to the input first, and accumulate
  independent,  ///< outpaint every view from the input alone; nothing is accumulated
};

/// A view that a scene shows.
struct ViewPlan {
  std::string name;  ///< "left" at the extreme of a direction, "left_1" on the way to it
  Pose world_from_cam = Pose::Identity();
  bool outpaint = false;  ///< whether it is outpainted; else the cloud is splatted into it
};

struct PlanOptions {
  Strategy strategy = Strategy::support;
  std::vector<std::string> directions = direction_names();
  int views_per_direction = 2;  ///< the last one is at the extreme; even steps
  PathOptions range;            ///< `frames` is not looked at
};

/// @return the strategy of this name; throws ps::Error naming the choices
Strategy strategy_of(const std::string& name);

/// @brief The input's view, "input", and the views of every direction (SPEC.md 2) from there. Those
/// that are outpainted are in the order in which that is to be done: the directions as given, and
/// for `sequential` the nearest of all directions before the next ones.
/// Throws ps::Error when a direction is none of direction_names() or given twice,
/// views_per_direction is not 1 to 1000, or a range is unsound (camera_path()).
std::vector<ViewPlan> plan_scene(const Pose& input, const PlanOptions& options = {});

}  // namespace ps
