// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "libps/scene/scene_builder.h"
#include "libps/scene/scene_plan.h"
#include "libps/scene/view_renderer.h"

namespace ps {

/// @brief A scene that is outpainted by a strategy (PixelSynth, section 4.3): as a SceneBuilder,
/// but `independent` views are made of what was observed alone. All are added to one cloud.
class StrategyScene {
 public:
  StrategyScene(Strategy strategy, const SceneNetworks& networks, const Intrinsics& lens,
                const SceneOptions& options = {});

  // As SceneBuilder's.
  AddReport observe(const View& view, std::uint16_t number,
                    const std::function<Depth()>& depth_again = {});
  SupportView outpaint(const Pose& world_from_cam, std::uint16_t number);
  AddReport add(const SupportView& support, std::uint16_t number);
  const Cloud& cloud() { return scene_.cloud(); }
  const Intrinsics& lens() const { return scene_.lens(); }

  /// @return whether outpainted views are shown as they are; else the cloud is splatted into them
  bool shows_outpainted() const { return strategy_ != Strategy::support; }

 private:
  Strategy strategy_;
  SceneBuilder scene_;
  std::optional<SceneBuilder> observed_;  ///< what was observed alone, where that is asked for
};

/// A picture that a strategy makes of a planned view, through the networks' lens.
struct ShownView {
  ViewPlan plan;
  Image image;
  SupportReport report;  ///< where it was outpainted
};

struct ShownScene {
  StrategyScene scene;           ///< with all that was accumulated
  std::vector<ShownView> views;  ///< in the order of the plan
};

/// @brief Makes all views of a plan by its strategy (PixelSynth, section 4.3), from one input:
/// `support` splats and refines the accumulated cloud into each; the others show what was
/// outpainted in each.
/// @param input     with depth
/// @param plan      of plan_scene() from the input's pose; 65535 views to outpaint at the most
/// @param strategy  that the plan was made for
/// @return all views of the plan, each with a picture. A view that options.outpaint.progress
/// stopped (it returned false) adds nothing and is rendered from the cloud, with report.best -1;
/// the next one is begun.
/// Throws ps::Error as SceneBuilder and ViewRenderer do, and whatever progress throws.
ShownScene show_scene(const View& input, const std::vector<ViewPlan>& plan, Strategy strategy,
                      const SceneNetworks& networks, const SceneOptions& options,
                      const ViewRendererOptions& renderer);

}  // namespace ps
