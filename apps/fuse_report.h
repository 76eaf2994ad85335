// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "apps/context.h"
#include "apps/frame_list.h"
#include "apps/report.h"
#include "libps/scene/frame_study.h"

namespace ps::apps {

/// What fusing came to.
struct Fused {
  Cloud cloud;
  FuseReport report;
  double tolerance_relative = 0;    ///< that it was fused with
  std::optional<FrameStudy> study;  ///< if it was asked for
  std::size_t scaled = 0;           ///< depth images scaled to their photos' size

  std::size_t refused() const;  ///< frames
};

/// @brief What was made of the frames; with a study also what it came to, frame by frame. Frames
/// have the names of their photos.
/// @param frames  one for each word of the study
Json report_of(const Fused& fused, const FrameList& frames);

/// @brief Warns of frames that are left out, of depths that were scaled, of a study that gave up.
void warn_of(const Fused& fused, const Context& context);

}  // namespace ps::apps
