// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "apps/eval_models.h"
#include "apps/frames_arguments.h"
#include "apps/interrupt.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/scene_arguments.h"
#include "apps/scene_models.h"
#include "apps/score_report.h"
#include "apps/verb_eval.h"
#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/eval/cloud_metrics.h"
#include "libps/eval/consistency.h"
#include "libps/geometry/point.h"
#include "libps/scene/strategies.h"

namespace ps::apps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> all_methods() { return {"support", "sequential", "independent"}; }

struct EvalConsistencyArguments {
  FramesArguments frames;
  SceneArguments scene;  ///< ranges, directions, sampling and weights of it are used
  std::vector<std::string> methods = all_methods();
  bool estimate_depth = false;
  std::string lpips;
  std::string output;
};

std::vector<ScoreColumn> columns() {
  return {{"PSNR", "dB", true},
          {"LPIPS", "", false},
          {"overlap", "", true},
          {"seam step", "", false},
          {"step before seam", "", false},
          {"in front", "", false},
          {"depth agreed", "", true},
          {"seconds", "s", false}};
}

/// Means over the directions of a shown scene.
std::vector<double> scores_of(const ShownScene& shown, const Cloud& cloud, const Intrinsics& lens,
                              const View& input, const PerceptualDistance& perceptual,
                              double seconds) {
  std::vector<double> psnr, lpips, overlap, steps, steps_seen, agreed;
  const auto add = [](std::vector<double>& values, double value) {
    if (!std::isnan(value)) values.push_back(value);
  };
  for (const ShownView& half : shown.views) {
    const std::size_t number = half.plan.name.find("_1");
    if (half.report.best >= 0) {
      add(steps, half.report.seam_step);
      add(steps_seen, half.report.seam_step_seen);
      agreed.push_back(half.report.agreed ? 1 : 0);
    }
    if (number == std::string::npos) continue;
    for (const ShownView& full : shown.views) {
      if (full.plan.name != half.plan.name.substr(0, number)) continue;
      const ConsistencyScore score =
          consistency({half.image, {}, lens, half.plan.world_from_cam},
                      {full.image, {}, lens, full.plan.world_from_cam}, perceptual);
      if (score.overlap == 0) continue;
      psnr.push_back(score.psnr);
      lpips.push_back(score.perceptual);
      overlap.push_back(score.overlap);
    }
  }
  return {mean(psnr),         mean(lpips),
          mean(overlap),      median(steps),
          median(steps_seen), share_in_front(cloud, Origin::outpainted, input),
          mean(agreed),       seconds};
}

ScoreTable measure(const EvalConsistencyArguments& a, const ChosenFrames& frames,
                   const SceneModels& models, const PerceptualDistance& perceptual,
                   const Context& context) {
  ScoreTable table(columns());
  SceneOptions options = a.scene.scene(context);
  options.cloud.lift.estimated = a.estimate_depth;
  options.outpaint.progress = unless_interrupted;
  PlanOptions plan_options = a.scene.plan();
  plan_options.views_per_direction = 2;
  ViewRendererOptions renderer;
  renderer.seed = context.seed;
  Progress progress(context, "scenes", frames.chosen.size() * a.methods.size());
  for (std::size_t i = 0; i < frames.chosen.size(); ++i) {
    View input = frames.load(i);
    complete_depth(input, models.depth(), a.estimate_depth);
    for (const std::string& method : a.methods) {
      plan_options.strategy = strategy_of(method);
      const Stopwatch watch;
      ShownScene shown = show_scene(input, plan_scene(input.world_from_cam, plan_options),
                                    plan_options.strategy, models.networks(), options, renderer);
      const double seconds = watch.seconds();
      table.add(
          {method, frames.name(i), frames.groups[i],
           scores_of(shown, shown.scene.cloud(), shown.scene.lens(), input, perceptual, seconds)});
      progress.update(table.rows().size());
    }
  }
  return table;
}

void run_eval_consistency(const EvalConsistencyArguments& a, const CLI::App& verb,
                          const Context& context) {
  check_score_files(a.output);
  note_interrupts();
  const Stopwatch total;
  const SceneModels models(a.scene.weights, a.scene.select, context);
  const PerceptualModel perceptual(a.lpips);
  const ChosenFrames frames = choose_posed_frames(a.frames, context);
  const ScoreTable table = measure(a, frames, models, perceptual.distance(), context);
  const ScoreSummary summary = summary_of(table, bootstrap_of(context));
  const Json measured = {{"frames", frames_report(a.frames, frames)}};
  end_scores(
      context,
      {a.output, a.frames.data, score_report(verb, context, measured, "methods", summary), summary,
       &table, "consistency of " + counted(frames.chosen.size(), "scene") + " scored"},
      total);
}

}  // namespace

void add_eval_consistency(CLI::App& eval, const Context& context) {
  auto* verb = eval.add_subcommand(
      "consistency",
      std::string(
          "How well views of one scene agree (SPEC 11): each frame becomes a scene, and in each "
          "direction the view at the extreme is held against the one half way, by homography, both "
          "ways, on their overlap. Also of each scene: the median relative step of depth across "
          "the "
          "seam of what was outpainted, and between seen pixels just before it, and the share of "
          "outpainted points that stand before what the "
          "input saw.") +
          kIntervalsHelp);
  auto a = std::make_shared<EvalConsistencyArguments>();
  a->frames.add_to(*verb);
  add_names(*verb, "--methods", a->methods, "Of support, sequential, independent", all_methods());
  a->scene.add_view_options(*verb);
  a->scene.add_outpaint_options(*verb);
  verb->add_flag("--estimate-depth", a->estimate_depth, "Look at no true depth of the frames");
  add_lpips_option(*verb, a->lpips);
  add_score_output(*verb, a->output, "every frame");
  verb->callback([a, verb, &context] { run_eval_consistency(*a, *verb, context); });
}

}  // namespace ps::apps
