// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/scene/scene_builder.h"
#include "libps/scene/scene_plan.h"
#include "libps/scene/view_renderer.h"

namespace ps {

/// A picture that a strategy makes of a planned view, through the networks' lens.
struct ShownView {
  ViewPlan plan;
  Image image;
  SupportReport report;  ///< where it was outpainted
};

struct ShownScene {
  SceneBuilder scene;            ///< with all that was accumulated
  std::vector<ShownView> views;  ///< in the order of the plan
};

/// @brief Makes all views of a plan by its strategy (PixelSynth, section 4.3), from one input:
/// `support` splats and refines the accumulated cloud into each; the others show what was
/// outpainted in each.
/// @param plan      of plan_scene() from the input's pose
/// @param strategy  that the plan was made for
ShownScene show_scene(const View& input, const std::vector<ViewPlan>& plan, Strategy strategy,
                      const SceneNetworks& networks, const SceneOptions& options,
                      const ViewRendererOptions& renderer);

}  // namespace ps
