// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/strategies.h"

#include <memory>

#include "libps/geometry/point.h"

namespace ps {

std::vector<ShownView> show_scene(
    const View& input, const std::vector<PlannedView>& plan, Strategy strategy,
    const SceneNetworks& networks, const SceneOptions& options,
    const ViewRendererOptions& renderer_options,
    const std::function<SupportView(SceneBuilder&, const Pose&, std::uint16_t)>& make_support) {
  SceneBuilder scene(networks, input.intrinsics, options);
  scene.observe(input, 0);
  std::vector<ShownView> shown;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    shown.push_back({plan[i], {}});
    if (!plan[i].outpaint) continue;
    const auto number = static_cast<std::uint16_t>(i + 1);
    const SupportView support = make_support
                                    ? make_support(scene, plan[i].world_from_cam, number)
                                    : scene.outpaint(plan[i].world_from_cam, number);
    if (strategy != Strategy::support) shown.back().image = support.view.color;
    if (strategy != Strategy::independent) scene.add(support, number);
  }
  ViewRenderer renderer(networks.outpaint.refiner, renderer_options);
  for (ShownView& view : shown) {
    if (!view.image.empty()) continue;
    view.image = renderer.render(scene.cloud(), scene.lens(), view.plan.world_from_cam).color;
  }
  return shown;
}

}  // namespace ps
