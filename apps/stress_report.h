// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/output.h"
#include "apps/report.h"
#include "libps/scene/stress.h"

namespace ps::apps {

/// What an axis came to, without its pictures.
struct StressRow {
  stress::Axis axis;
  stress::AxisResult result;
};

/// @brief Writes NAME.png, the curves, NAME-before.png and NAME-after.png: all methods at the
/// last value where ours holds and at the first where it is broken (which is left out if it never
/// is), and NAME-others.png: each other method just before and just after it breaks itself. Then
/// empties the result's pictures.
void write_axis_pictures(OutputFolder& out, StressRow& row);

/// @return the files that write_axis_pictures() may write
std::vector<std::string> axis_files(const std::string& axis);

/// @return a line for each axis: the breaking points of all methods
std::string breaking_table(const std::vector<StressRow>& rows);

/// @return breaking_table() and, for each axis, what it is, its criterion and its pictures; then
/// where ours is not the last to break, and violations. Markdown.
/// @param data  what was put under stress: "procedural rooms"
std::string stress_markdown(const std::vector<StressRow>& rows, const std::string& data);

/// @return lines for the user, of what a breaking point alone does not say: jumps of ours, and
/// where ours is broken before anything goes wrong
std::vector<std::string> stress_notes(const std::vector<StressRow>& rows);

/// @return {AXIS: {..., methods: {METHOD: {breaks, scores}}}}, numbers as json_number() has them:
/// "inf" = it never breaks, null = no score
Json to_json(const std::vector<StressRow>& rows);

/// @return axis,method,value,score; numbers as csv_number() has them
std::string to_csv(const std::vector<StressRow>& rows);

}  // namespace ps::apps
