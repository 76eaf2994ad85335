// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/scene_plan.h"

#include <algorithm>
#include <set>

#include "libps/core/error.h"

namespace ps {
namespace {

void check(const PlanOptions& options) {
  if (options.views_per_direction < 1 || options.views_per_direction > 1000) {
    throw Error("views per direction", std::to_string(options.views_per_direction), "1 to 1000");
  }
  const auto& names = direction_names();
  std::set<std::string> given;
  for (const std::string& direction : options.directions) {
    if (std::find(names.begin(), names.end(), direction) == names.end()) {
      std::string choices;
      for (const std::string& name : names) choices += (choices.empty() ? "" : ", ") + name;
      throw Error("directions", "there is none named '" + direction + "'", choices);
    }
    if (!given.insert(direction).second) {
      throw Error("directions", direction + " is given twice", "each once");
    }
  }
}

}  // namespace

Strategy strategy_of(const std::string& name) {
  if (name == "support") return Strategy::support;
  if (name == "sequential") return Strategy::sequential;
  if (name == "independent") return Strategy::independent;
  throw Error("strategy", "there is none named '" + name + "'",
              "support, sequential or independent");
}

std::vector<ViewPlan> plan_scene(const Pose& input, const PlanOptions& options) {
  check(options);
  const int steps = options.views_per_direction;
  PathOptions path = options.range;
  path.frames = steps + 1;
  std::vector<std::vector<Pose>> poses;
  for (const std::string& direction : options.directions) {
    poses.push_back(camera_path(direction, input, path));
  }
  std::vector<ViewPlan> views = {{"input", input, false}};
  for (int step = 1; step <= steps; ++step) {
    for (std::size_t d = 0; d < poses.size(); ++d) {
      const bool extreme = step == steps;
      const std::string number = extreme ? "" : "_" + std::to_string(step);
      views.push_back({options.directions[d] + number, poses[d][static_cast<std::size_t>(step)],
                       extreme || options.strategy != Strategy::support});
    }
  }
  return views;
}

}  // namespace ps
