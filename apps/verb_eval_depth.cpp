// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>
#include <vector>

#include "apps/depth_model.h"
#include "apps/frames_arguments.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/score_report.h"
#include "apps/verb_eval.h"
#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/eval/depth_baselines.h"
#include "libps/eval/depth_metrics.h"

namespace ps::apps {
namespace {

struct EvalDepthArguments {
  FramesArguments frames;
  std::string weights;
  std::string output;
};

std::vector<ScoreColumn> columns() {
  std::vector<ScoreColumn> all;
  for (const std::string raw : {"", " raw"}) {
    all.push_back({"AbsRel" + raw, "", false});
    all.push_back({"RMSE" + raw, "m", false});
    for (const char* delta : {"delta_1", "delta_2", "delta_3"})
      all.push_back({delta + raw, "", true});
  }
  return all;
}

/// In the columns' order.
std::vector<double> scores_of(const Depth& depth, const Depth& truth) {
  std::vector<double> values;
  for (const DepthErrors& e :
       {depth_errors(median_scaled(depth, truth), truth), depth_errors(depth, truth)}) {
    values.insert(values.end(), {e.abs_rel, e.rmse, e.delta[0], e.delta[1], e.delta[2]});
  }
  return values;
}

DepthBaselines learnt_baselines(const ChosenFrames& frames, const Context& context) {
  DepthBaselines baselines;
  bool any = false;
  Progress progress(context, "baselines", frames.chosen.size());
  for (std::size_t i = 0; i < frames.chosen.size(); ++i) {
    const View view = frames.load(i);
    any = any || has_depth(view);
    baselines.learn(view.depth);
    progress.update(i + 1);
  }
  if (!any) {
    throw Error("eval depth", frames.all.layout + ": no frame has any depth to score against",
                "frames with true depth");
  }
  return baselines;
}

ScoreTable measure(const ChosenFrames& frames, const DepthModel& model, const Context& context) {
  const DepthBaselines baselines = learnt_baselines(frames, context);
  ScoreTable table(columns());
  Progress progress(context, "depth", frames.chosen.size());
  for (std::size_t i = 0; i < frames.chosen.size(); ++i) {
    const View view = frames.load(i);
    const std::string& name = frames.name(i);
    if (has_depth(view)) {
      const auto add = [&](const char* method, const Depth& depth) {
        table.add({method, name, frames.groups[i], scores_of(depth, view.depth)});
      };
      add("ours", photo_depth(model.net, view.color, view.intrinsics, model.scale));
      add("constant", baselines.constant(view.depth.size()));
      add("row ramp", baselines.ramp(view.depth.size()));
      add("mean", baselines.mean(view.depth));
    }
    progress.update(i + 1);
  }
  return table;
}

void run_eval_depth(const EvalDepthArguments& a, const CLI::App& verb, const Context& context) {
  check_score_files(a.output);
  note_interrupts();
  const Stopwatch total;
  const DepthModel model = load_depth_model(a.weights, context);
  const ChosenFrames frames = choose_posed_frames(a.frames, context);
  const ScoreTable table = measure(frames, model, context);
  throw_if_interrupted();
  const ScoreSummary summary = summary_of(table, bootstrap_of(context));
  const Json measured = {{"frames", frames_report(a.frames, frames)}, {"weights", model.weights}};
  const std::size_t scored = table.rows().size() / table.methods().size();
  end_scores(context,
             {a.output, a.frames.data, score_report(verb, context, measured, "methods", summary),
              summary, &table, "depth of " + counted(scored, "frame") + " scored"},
             total);
}

}  // namespace

void add_eval_depth(CLI::App& eval, const Context& context) {
  auto* verb = eval.add_subcommand(
      "depth",
      std::string(
          "Scores estimated depth against true depth: AbsRel, RMSE and delta_1 to delta_3 (shares "
          "within 1.25, 1.25^2, 1.25^3), each image scaled to the true median, and raw. Beside it "
          "what "
          "knows nothing of the photo: a constant and a ramp by rows, both learnt from the very "
          "depths that are scored, and at each place the mean of the other frames' depths.") +
          kIntervalsHelp);
  auto a = std::make_shared<EvalDepthArguments>();
  a->frames.add_to(*verb);
  add_weights_option(*verb, a->weights);
  add_score_output(*verb, a->output, "every frame");
  verb->callback([a, verb, &context] { run_eval_depth(*a, *verb, context); });
}

}  // namespace ps::apps
