// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/report.h"
#include "libps/geometry/relative_pose.h"
#include "libps/scene/scene_builder.h"

namespace ps::apps {

/// @brief Adds to a report what a stage took: seconds.STAGE, and peak_memory_mib_after.STAGE, the
/// most memory that the process had held by its end.
void end_stage(Json& report, const std::string& stage, const Stopwatch& watch);

/// @brief What a report says of one outpainted view.
/// @param samples  completions that were asked for at most
Json to_json(const std::string& name, const SupportReport& report, int samples);

/// @brief What one view did to the cloud.
Json to_json(const AddReport& report);

/// @brief What an earlier scene wrote into a folder, by its report.json there, that a scene of
/// other views or videos would not replace.
/// @return relative names; none where there is no report of a scene
std::vector<std::string> pictures_of_earlier_scene(const std::filesystem::path& folder);

/// Of a second photo's pose that was found.
Json to_json(const SecondPose& found);

}  // namespace ps::apps
