// SPDX-License-Identifier: BSD-3-Clause
#include "apps/scene_maker.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/interrupt.h"
#include "apps/lift_arguments.h"
#include "apps/scene_report.h"
#include "io/trajectory.h"
#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/scene/camera_path.h"

namespace ps::apps {
namespace {

constexpr std::size_t kSteps = 1000;  ///< of progress, for each view

/// A photo's pixels are worth keeping down to half a pixel of the pictures.
constexpr int kFinest = 2;

}  // namespace

SceneMaker::SceneMaker(const SceneArguments& arguments, const Json& settings,
                       const Context& context)
    : a_(arguments),
      context_(context),
      settings_(settings),
      plan_options_(arguments.plan()),
      options_(arguments.scene(context)) {
  a_.point_budget();  // fails before the work
  options_.cloud.lift.estimated = a_.input.needs_estimate();
  check_depth_range(a_.input.lift);
  options_.outpaint.progress = [this](double done) {
    bar_->update(done_ * kSteps + static_cast<std::size_t>(std::lround(done * kSteps)));
    return true;
  };
}

void SceneMaker::load_networks() {
  const Stopwatch watch;
  if (!a_.no_outpaint) {
    models_ = std::make_unique<SceneModels>(a_.weights, a_.select, context_);
  } else if (a_.input.needs_estimate()) {
    depth_ = std::make_unique<DepthModel>(load_depth_model(depth_weights(a_.weights), context_));
  }
  end_stage(report_, "load_networks", watch);
}

void SceneMaker::make_plan() {
  plan_ = plan_scene(input_.first.world_from_cam, plan_options_);
  if (a_.support_views.empty()) return;
  std::size_t number = 0;
  for (const StampedPose& pose : read_trajectory(a_.support_views)) {
    plan_.push_back({"support_" + std::to_string(++number), pose.world_from_cam, true});
  }
}

AddReport SceneMaker::observe_all(SceneCloud& plain) {
  AddReport sum;
  std::vector<Pose> poses;
  const bool frames = input_.load_depth != nullptr;
  std::size_t without_depth = input_.without_depth;
  std::optional<Progress> progress;
  if (frames) progress.emplace(context_, "frames", input_.count);
  for (std::size_t i = 0; i < input_.count; ++i) {
    throw_if_interrupted();
    const View view = i == 0 ? input_.first : input_.load(i);
    if (progress) progress->update(i + 1);
    if (view.depth.empty()) {
      ++without_depth;
      continue;
    }
    const auto number = static_cast<std::uint16_t>(poses.size());
    std::function<Depth()> again;
    if (frames) again = [load = input_.load_depth, i] { return load(i); };
    sum += scene_ ? scene_->observe(view, number, again) : plain.add(view, number);
    poses.push_back(view.world_from_cam);
  }
  observed_ = poses.size();
  input_.load = nullptr;  // what photos it holds is in the cloud now
  if (!frames) return sum;
  up_ = up_axis(poses);
  report_["depth"]["frames"] = observed_;
  if (without_depth > 0) {
    context_.warn(counted(without_depth, "frame has", "frames have") + " no depth at all and " +
                  (without_depth == 1 ? "is" : "are") + " left out");
  }
  return sum;
}

void SceneMaker::observe() {
  const Stopwatch watch;
  SceneCloud plain(options_.cloud);
  if (models_) {
    scene_ = std::make_unique<StrategyScene>(plan_options_.strategy, models_->networks(), lens(),
                                             options_);
  }
  report_["pixels"] = to_json(observe_all(plain));
  cloud_ = scene_ ? scene_->cloud() : plain.cloud();
  if (cloud_.empty()) {
    throw Error(a_.input.photo, "no pixel can be lifted", "depth in the range asked for");
  }
  end_stage(report_, "observe", watch);
}

SupportView SceneMaker::outpaint(const ViewPlan& view, std::uint16_t number) {
  SupportView support;
  Json report;
  if (work_->load(number, support, report)) {
    support.view.intrinsics = scene_->lens();
    support.view.world_from_cam = view.world_from_cam;
    report["resumed"] = true;
  } else {
    support = scene_->outpaint(view.world_from_cam, number);
    report = to_json(view.name, support.report, options_.outpaint.samples);
    work_->save(number, support, report);
  }
  const Stopwatch watch;
  report["points"] = to_json(scene_->add(support, number));
  if (report.contains("seconds")) report["seconds"]["add"] = watch.seconds();
  report_["support_views"].push_back(report);
  ++done_;
  bar_->update(done_ * kSteps);
  return support;
}

void SceneMaker::outpaint_all() {
  const Stopwatch watch;
  report_["support_views"] = Json::array();
  const auto wanted =
      std::count_if(plan_.begin(), plan_.end(), [](const auto& view) { return view.outpaint; });
  bar_ =
      std::make_unique<Progress>(context_, "outpaint", static_cast<std::size_t>(wanted) * kSteps);
  const bool shown = scene_->shows_outpainted();
  if (shown) painted_.resize(plan_.size());
  for (std::size_t i = 0; i < plan_.size(); ++i) {
    if (!plan_[i].outpaint) continue;
    const std::size_t number = observed_ + done_;
    const SupportView support = outpaint(plan_[i], static_cast<std::uint16_t>(number));
    if (shown) painted_[i] = support.view.color;
  }
  bar_.reset();
  cloud_ = scene_->cloud();
  end_stage(report_, "outpaint", watch);
}

void SceneMaker::make() {
  load_networks();
  const Stopwatch watch;
  const DepthModel* depth = models_ ? &models_->depth() : depth_.get();
  input_ = read_scene_input(a_.input, depth, kFinest * a_.view_size, context_);
  report_.update(input_.report);
  end_stage(report_, "read_input", watch);
  make_plan();
  if (plan_.size() + input_.count > 65536) {
    throw Error("scene", "there are more than 65536 views", "fewer frames or support views");
  }
  observe();
  if (!models_) return;
  std::vector<std::filesystem::path> inputs = a_.input.files();
  if (!a_.support_views.empty()) inputs.emplace_back(a_.support_views);
  inputs.insert(inputs.end(), models_->files().begin(), models_->files().end());
  work_ = std::make_unique<SceneWork>(a_.output, settings_, inputs, a_.resume);
  outpaint_all();
}

void SceneMaker::keep_to_budget(const std::vector<PlannedView>& views) {
  std::optional<BudgetOptions> options = a_.point_budget();
  if (!options) return;
  const Stopwatch watch;
  BudgetReport done;
  const std::size_t before = cloud_.size();
  {
    Progress bar(context_, "budget", kSteps);
    options->progress = [&](double share) {
      bar.update(static_cast<std::size_t>(std::lround(share * kSteps)));
    };
    cloud_ = thinned(cloud_, views, *options, &done);
  }
  Json& report = report_["budget"] = {
      {"views", views.size()}, {"points_before", before},        {"points", done.points},
      {"merged", done.merged}, {"seen_by_no_view", done.unseen}, {"tolerance", done.tolerance},
      {"pixels", done.pixels}};
  const bool targeted = options->points > 0 || options->psnr > 0;
  if (targeted) report["psnr"] = std::isfinite(done.psnr) ? Json(done.psnr) : Json("inf");
  if (options->points > 0 && done.points > options->points) {
    report["points_asked"] = options->points;
    context_.warn("--budget points=" + std::to_string(options->points) + ": " +
                  counted(done.points, "point stays", "points stay") +
                  ", as observed and outpainted ones are not merged, nor what lies far apart or is "
                  "seen by no view");
  }
  end_stage(report_, "budget", watch);
  throw_if_interrupted();
}

void SceneMaker::finish() {
  if (work_) work_->finish();
}

}  // namespace ps::apps
