// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>
#include <vector>

#include "apps/output.h"
#include "apps/program.h"
#include "apps/score_report.h"
#include "apps/verb_eval.h"
#include "io/cloud_file.h"
#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/eval/cloud_intervals.h"

namespace ps::apps {
namespace {

namespace fs = std::filesystem;

struct EvalCloudArguments {
  std::string cloud, truth;
  std::vector<double> thresholds = {0.01, 0.02, 0.05};
  double block = 0.5;
  std::string output;
};

ScoreSummary summary_of(const std::string& cloud, const CloudIntervals& found) {
  ScoreSummary summary = {"cloud", {cloud}, {}, {{}}};
  const auto add = [&](const std::string& name, const char* unit, bool higher, const Interval& i) {
    summary.columns.push_back({name, unit, higher});
    summary.cells.front().push_back(i);
  };
  for (const CloudScoreInterval& score : found.scores) {
    const std::string at = " " + in_digits(score.threshold) + " m";
    add("accuracy" + at, "", true, score.accuracy);
    add("completeness" + at, "", true, score.completeness);
    add("F-score" + at, "", true, score.f_score);
  }
  add("chamfer", "m", false, found.chamfer);
  return summary;
}

/// Says how many points are not finite and left out.
Cloud read_points(const std::string& path, const Context& context, std::size_t* not_finite) {
  Cloud cloud = read_cloud(path, not_finite);
  const std::string dropped = counted(*not_finite, "point is", "points are") + " not finite";
  if (cloud.empty()) {
    throw Error(path, *not_finite > 0 ? "holds no point; " + dropped : "holds no point",
                "a cloud with points");
  }
  if (*not_finite > 0) context.warn(path + ": " + dropped + " and not scored");
  return cloud;
}

void run_eval_cloud(const EvalCloudArguments& a, const CLI::App& verb, const Context& context) {
  check_score_files(a.output, {a.cloud, a.truth});
  const Stopwatch total;
  std::size_t not_finite = 0, true_not_finite = 0;
  const Cloud cloud = read_points(a.cloud, context, &not_finite);
  const Cloud truth = read_points(a.truth, context, &true_not_finite);
  const CloudIntervals found =
      cloud_intervals(cloud, truth, a.thresholds, a.block, bootstrap_of(context));
  const ScoreSummary summary = summary_of(fs::path(a.cloud).filename().string(), found);
  const Json measured = {{"points", cloud.size()},
                         {"true_points", truth.size()},
                         {"not_finite", not_finite},
                         {"true_not_finite", true_not_finite}};
  end_scores(
      context,
      {a.output, a.cloud, score_report(verb, context, measured, "clouds", summary), summary,
       nullptr, counted(cloud.size(), "point") + " scored against " + std::to_string(truth.size()),
       3},
      total);
}

}  // namespace

void add_eval_cloud(CLI::App& eval, const Context& context) {
  auto* verb = eval.add_subcommand(
      "cloud",
      "Scores a cloud against a true one: accuracy (share of its points nearer than a threshold to "
      "a true point), completeness (the other way round), F-score (their harmonic mean), and the "
      "chamfer distance (mean of the two mean nearest distances).\n"
      "Below each figure its 95 % bootstrap interval over blocks of space.");
  auto a = std::make_shared<EvalCloudArguments>();
  verb->add_option("cloud", a->cloud, "PLY or PCD to score")->required()->type_name("CLOUD");
  verb->add_option("truth", a->truth, "PLY or PCD that is true, in the same world")
      ->required()
      ->type_name("TRUTH");
  verb->add_option("--thresholds", a->thresholds, "Metres, as 0.01,0.02,0.05")
      ->delimiter(',')
      ->type_name("M,...")
      ->check(in_range(1e-9, kNoBound));
  verb->add_option("--block", a->block, "Side of the blocks that are drawn for intervals, metres")
      ->type_name("M")
      ->check(in_range(1e-6, kNoBound));
  add_score_output(*verb, a->output);
  verb->callback([a, verb, &context] { run_eval_cloud(*a, *verb, context); });
}

}  // namespace ps::apps
