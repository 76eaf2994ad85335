// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/report.h"
#include "libps/scene/scene_builder.h"

namespace ps::apps {

/// @brief What a report says of one outpainted view.
/// @param samples  completions that were asked for at most
Json to_json(const std::string& name, const SupportReport& report, int samples);

/// @brief What one view did to the cloud.
Json to_json(const AddReport& report);

}  // namespace ps::apps
