// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

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

/// @brief Pairs of frames of DATA, which must have depth; `count` at most. Throws ps::Error when
/// there is no pair, CLI::ValidationError as choose_posed_frames() does.
ChartSamples frame_samples(const FramesArguments& arguments, std::size_t count,
                           const Context& context);

}  // namespace ps::apps
