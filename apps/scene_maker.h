// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "apps/progress.h"
#include "apps/scene_arguments.h"
#include "apps/scene_models.h"
#include "apps/scene_work.h"
#include "libps/geometry/point.h"
#include "libps/scene/strategies.h"

namespace ps::apps {

/// @brief From the arguments of `scene` to its cloud: reads, observes, outpaints.
class SceneMaker {
 public:
  /// Throws CLI::ValidationError where arguments do not go together.
  SceneMaker(const SceneArguments& arguments, const Json& settings, const Context& context);

  /// @brief Makes the cloud. Throws ps::Error, and Interrupted: what was outpainted until then is
  /// kept for --resume.
  void make();
  /// @brief Thins the cloud to what these views need, by --budget.
  void keep_to_budget(const std::vector<PlannedView>& views);
  /// The scene is complete and in its place: what --resume would need is removed.
  void finish();

  bool has_begun() const { return done_ > 0; }  ///< there is something to resume
  const Intrinsics& lens() const { return input_.first.intrinsics; }  ///< the first view's
  const std::string& up() const { return up_; }                       ///< the world's axis
  const Cloud& cloud() const { return cloud_; }
  const std::vector<ViewPlan>& plan() const { return plan_; }
  /// Null where nothing is outpainted.
  const SceneModels* models() const { return models_.get(); }
  /// Pictures of views that are shown as they were outpainted (strategies other than support), in
  /// the order of the plan; empty where the cloud is splatted.
  const std::vector<Image>& painted() const { return painted_; }
  const Intrinsics& painted_lens() const { return scene_->lens(); }
  /// Of observing and outpainting; its `seconds` are those of the stages.
  const Json& report() const { return report_; }

 private:
  void load_networks();
  void make_plan();
  void observe();
  AddReport observe_all(SceneCloud& plain);
  void outpaint_all();
  SupportView outpaint(const ViewPlan& view, std::uint16_t number);

  const SceneArguments& a_;
  const Context& context_;
  const Json settings_;
  const PlanOptions plan_options_;
  SceneOptions options_;
  std::unique_ptr<SceneModels> models_;
  std::unique_ptr<DepthModel> depth_;  ///< where nothing is outpainted
  SceneInput input_;
  std::vector<ViewPlan> plan_;
  std::unique_ptr<SceneWork> work_;
  std::unique_ptr<StrategyScene> scene_;
  std::unique_ptr<Progress> bar_;
  std::string up_ = "y";
  std::size_t observed_ = 0;  ///< views that were observed
  std::size_t done_ = 0;      ///< views that are outpainted
  std::vector<Image> painted_;
  Cloud cloud_;
  Json report_;
};

}  // namespace ps::apps
