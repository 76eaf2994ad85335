// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_samples.h"

#include <memory>

#include "libps/core/error.h"
#include "libps/scene/knob_samples.h"
#include "libps/scene/room_view.h"

namespace ps::apps {
namespace {

void check_lens(const View& view, const View& input, const std::string& name) {
  if (view.color.size() == input.color.size()) return;
  throw Error(name, "is of another size than other frames", "frames of one camera");
}

}  // namespace

ChartSamples room_samples(std::size_t count, int side, const Context& context) {
  constexpr std::uint64_t kFirst = 9001;
  const std::uint64_t first = room_number(kFirst + context.seed, 0);
  return {count,
          [=](std::size_t i) {
            KnobSample sample = room_sample(first + i, side);
            sample.group = static_cast<int>(i);
            return sample;
          },
          {{"data", "rooms"}, {"samples", count}, {"side", side}, {"first_room", first}}};
}

View load_with_depth(const ChosenFrames& frames, std::size_t i) {
  View view = frames.load(i);
  if (!has_depth(view)) throw Error(frames.name(i), "has no depth", "frames with true depth");
  check(view, frames.name(i));
  return view;
}

ChartSamples frame_samples(std::shared_ptr<const ChosenFrames> frames, std::size_t count,
                           bool with_others, const Context& context) {
  constexpr std::size_t kApart = 3;
  const auto pose = [&](std::size_t i) { return frames->pose(i); };
  const auto sets = std::make_shared<std::vector<FrameSet>>(
      choose_frame_sets(frames->worlds(), pose, count, kApart, context.seed));
  const auto load = [=](std::size_t s) {
    const FrameSet& set = (*sets)[s];
    const auto view = [&](std::size_t i) { return load_with_depth(*frames, i); };
    KnobSample sample = {frames->name(set.pair.source) + " to " + frames->name(set.pair.target),
                         frames->groups[set.pair.source],
                         view(set.pair.source),
                         view(set.pair.target),
                         {},
                         {}};
    check_lens(sample.target, sample.input, frames->name(set.pair.target));
    if (!with_others) return sample;
    for (const std::size_t i : set.others) sample.others.push_back(view(i));
    return sample;
  };
  return {sets->size(), load, {{"samples", sets->size()}}};
}

ChartSamples frame_samples(const FramesArguments& arguments, std::size_t count,
                           const Context& context) {
  const auto frames = std::make_shared<ChosenFrames>(choose_posed_frames(arguments, context));
  ChartSamples samples = frame_samples(frames, count, true, context);
  if (samples.count == 0) {
    throw Error(arguments.data, "no two frames are a pair",
                "two of one world that look 20 to 60 degrees apart, within a metre");
  }
  samples.report = frames_report(arguments, *frames);
  samples.report["samples"] = samples.count;
  return samples;
}

}  // namespace ps::apps
