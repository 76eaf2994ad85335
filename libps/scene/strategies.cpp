// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/strategies.h"

#include "libps/geometry/point.h"

namespace ps {

StrategyScene::StrategyScene(Strategy strategy, const SceneNetworks& networks,
                             const Intrinsics& lens, const SceneOptions& options)
    : strategy_(strategy), scene_(networks, lens, options) {
  if (strategy == Strategy::independent) observed_.emplace(networks, lens, options);
}

AddReport StrategyScene::observe(const View& view, std::uint16_t number,
                                 const std::function<Depth()>& depth_again) {
  if (observed_) observed_->observe(view, number, depth_again);
  return scene_.observe(view, number, depth_again);
}

SupportView StrategyScene::outpaint(const Pose& world_from_cam, std::uint16_t number) {
  return (observed_ ? *observed_ : scene_).outpaint(world_from_cam, number);
}

AddReport StrategyScene::add(const SupportView& support, std::uint16_t number) {
  return scene_.add(support, number);
}

ShownScene show_scene(const View& input, const std::vector<ViewPlan>& plan, Strategy strategy,
                      const SceneNetworks& networks, const SceneOptions& options,
                      const ViewRendererOptions& renderer_options) {
  ShownScene shown = {StrategyScene(strategy, networks, input.intrinsics, options), {}};
  StrategyScene& scene = shown.scene;
  std::uint16_t number = 0;
  scene.observe(input, number);
  for (const ViewPlan& view : plan) {
    shown.views.push_back({view, {}, {}});
    if (!view.outpaint) continue;
    const SupportView support = scene.outpaint(view.world_from_cam, ++number);
    scene.add(support, number);
    shown.views.back().report = support.report;
    if (scene.shows_outpainted()) shown.views.back().image = support.view.color;
  }
  ViewRenderer renderer(networks.outpaint.refiner, renderer_options);
  for (ShownView& view : shown.views) {
    if (!view.image.empty()) continue;
    view.image = renderer.render(scene.cloud(), scene.lens(), view.plan.world_from_cam).color;
  }
  return shown;
}

}  // namespace ps
