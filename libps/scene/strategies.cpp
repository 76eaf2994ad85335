// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/strategies.h"

#include "libps/geometry/point.h"

namespace ps {

ShownScene show_scene(const View& input, const std::vector<ViewPlan>& plan, Strategy strategy,
                      const SceneNetworks& networks, const SceneOptions& options,
                      const ViewRendererOptions& renderer_options) {
  ShownScene shown = {SceneBuilder(networks, input.intrinsics, options), {}};
  SceneBuilder& scene = shown.scene;
  scene.observe(input, 0);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    shown.views.push_back({plan[i], {}, {}});
    if (!plan[i].outpaint) continue;
    const auto number = static_cast<std::uint16_t>(i + 1);
    const Pose& pose = plan[i].world_from_cam;
    const SupportView support = scene.outpaint(pose, number);
    shown.views.back().report = support.report;
    if (strategy != Strategy::support) shown.views.back().image = support.view.color;
    if (strategy != Strategy::independent) scene.add(support, number);
  }
  ViewRenderer renderer(networks.outpaint.refiner, renderer_options);
  for (ShownView& view : shown.views) {
    if (!view.image.empty()) continue;
    view.image = renderer.render(scene.cloud(), scene.lens(), view.plan.world_from_cam).color;
  }
  return shown;
}

}  // namespace ps
