// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/scene_input.h"
#include "libps/scene/budget.h"
#include "libps/scene/scene_builder.h"
#include "libps/scene/scene_plan.h"

namespace ps::apps {

/// The options of `scene`.
struct SceneArguments {
  SceneInputArguments input;
  std::string output;
  std::string weights;
  bool no_outpaint = false;
  bool resume = false;

  std::vector<std::string> directions = direction_names();
  std::string range_horizontal = "0.6", range_vertical = "0.3";
  double orbit = 0;
  std::string support_views;  ///< a trajectory of further views to outpaint
  std::string strategy = "support";
  int views_per_direction = 2;

  std::optional<std::string> samples;  ///< 1 to 1000 or auto; not given = auto where it may be
  double temperature = 0.5;
  double guidance = outpaint::OutpaintOptions::kGuidance;
  int refine_best = 0;
  std::string select = "consensus";

  /// none, auto, points=N or psnr=DB; not given = auto where it outpaints
  std::optional<std::string> budget;
  int view_size = 1024;
  std::vector<std::string> paths;
  int path_frames = 64;
  double frames_per_second = 30;

  void add_to(CLI::App& verb);
  void add_view_options(CLI::App& verb);      ///< directions, ranges, orbit
  void add_sampling_options(CLI::App& verb);  ///< sampling, weights
  void add_outpaint_options(CLI::App& verb);  ///< the same, and selection

  /// What was asked for, or else what is done then.
  std::string samples_text() const { return samples.value_or(refine_best > 0 ? "50" : "auto"); }
  std::string budget_text() const { return budget.value_or(no_outpaint ? "none" : "auto"); }

  /// Throw CLI::ValidationError (wrong usage) where a text is none of what is allowed.
  PlanOptions plan() const;
  SceneOptions scene(const Context& context) const;
  std::optional<BudgetOptions> point_budget() const;  ///< none = all points are kept
};

/// @return radians of `0.6`, `0.6rad` or `34deg`; throws CLI::ValidationError naming the option
double parse_angle(const std::string& text, const std::string& option);

}  // namespace ps::apps
