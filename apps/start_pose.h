// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/cloud_arguments.h"

namespace ps::apps {

/// Where a camera starts, and how far ahead lies what it looks at (0 = not known).
struct StartPose {
  Pose world_from_cam = Pose::Identity();
  double distance = 0;
};

/// @brief The first pose of `file`; if that is empty, of the trajectory beside the cloud; if there
/// is none, a pose that shows the cloud from outside. Says which of the latter two. Throws
/// ps::Error on a bad file.
StartPose choose_start(const std::string& file, const CloudArguments& arguments, const Cloud& cloud,
                       const Intrinsics& lens, const Context& context);

}  // namespace ps::apps
