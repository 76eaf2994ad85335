// SPDX-License-Identifier: BSD-3-Clause
#include "apps/stress_data.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "apps/chart_samples.h"
#include "apps/interrupt.h"

namespace ps::apps {
namespace {

using Numbers = std::vector<std::size_t>;

std::vector<View> load(const ChosenFrames& frames, const Numbers& numbers, Json* names) {
  std::vector<View> views;
  *names = Json::array();
  for (const std::size_t i : numbers) {
    throw_if_interrupted();
    views.push_back(load_with_depth(frames, i));
    names->push_back(frames.name(i));
  }
  return views;
}

void load_walks(const ChosenFrames& frames, const stress::SuiteOptions& options,
                stress::GivenFrames* given, Json* report) {
  const auto pose = [&](std::size_t i) { return frames.pose(i); };
  for (const stress::WalkChoice& walk : stress::choose_walks(frames.worlds(), pose, options)) {
    Json fused, left_out;
    std::vector<View> used = load(frames, walk.frames, &fused);
    given->walks.push_back({std::move(used), load(frames, walk.held_out, &left_out)});
    (*report)["walks"].push_back({{"fused", fused}, {"left_out", left_out}});
  }
}

void load_pairs(const std::shared_ptr<const ChosenFrames>& frames,
                const stress::SuiteOptions& options, const Context& context,
                stress::GivenFrames* given, Json* report) {
  const ChartSamples samples =
      frame_samples(frames, static_cast<std::size_t>(options.photos), false, context);
  for (std::size_t i = 0; i < samples.count; ++i) {
    throw_if_interrupted();
    KnobSample sample = samples.load(i);
    given->pairs.push_back({std::move(sample.input), std::move(sample.target)});
    (*report)["pairs"].push_back(sample.name);
  }
}

}  // namespace

StressData load_stress_data(const FramesArguments& arguments, const stress::SuiteOptions& options,
                            bool walks, bool pairs, const Context& context) {
  if (arguments.data.empty()) {
    return {nullptr, {{"data", "rooms"}, {"rooms", options.rooms}, {"photos", options.photos}}};
  }
  const auto frames = std::make_shared<ChosenFrames>(choose_posed_frames(arguments, context));
  const auto given = std::make_shared<stress::GivenFrames>();
  Json report = frames_report(arguments, *frames);
  if (walks) load_walks(*frames, options, given.get(), &report);
  if (pairs) load_pairs(frames, options, context, given.get(), &report);
  return {given, report};
}

}  // namespace ps::apps
