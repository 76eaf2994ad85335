// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "apps/frames_arguments.h"
#include "libps/scene/stress_axes.h"

namespace ps::apps {

/// What is put under stress.
struct StressData {
  std::shared_ptr<const stress::GivenFrames> given;  ///< null = procedural rooms
  Json report;                                       ///< of reports: where it is from
};

/// @brief Loads so many frames of DATA as the options want: walks and pairs, both of which may
/// turn out to be none; of no DATA, rooms. Throws ps::Error as choose_posed_frames() does and when
/// a frame has no depth, CLI::ValidationError as choose_posed_frames() does.
/// @param walks, pairs  whether they are needed
StressData load_stress_data(const FramesArguments& arguments, const stress::SuiteOptions& options,
                            bool walks, bool pairs, const Context& context);

}  // namespace ps::apps
