// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "apps/frames_arguments.h"
#include "libps/eval/knob.h"

namespace ps::apps {

/// What knobs are tried on, one at a time.
struct ChartSamples {
  std::size_t count = 0;
  std::function<KnobSample(std::size_t)> load;
  Json report;
};

/// @brief Procedural rooms that nothing was trained on: those of rooms:9001 with seed 0, and so on.
/// @param side  of views, pixels
ChartSamples room_samples(std::size_t count, int side, const Context& context);

/// @brief Pairs of these frames, which must have depth; `count` at most, and there may be none.
/// @param with_others  whether the frames beside a pair are loaded too
ChartSamples frame_samples(std::shared_ptr<const ChosenFrames> frames, std::size_t count,
                           bool with_others, const Context& context);

/// @brief Loads a frame. Throws ps::Error when it is unsound or has no depth.
View load_with_depth(const ChosenFrames& frames, std::size_t chosen_frame);

/// @brief Pairs of frames of DATA, which must have depth; `count` at most. Throws ps::Error when
/// there is no pair, CLI::ValidationError as choose_posed_frames() does.
ChartSamples frame_samples(const FramesArguments& arguments, std::size_t count,
                           const Context& context);

}  // namespace ps::apps
