// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/context.h"
#include "libps/core/clock.h"
#include "libps/geometry/camera.h"
#include "libps/geometry/point.h"

namespace ps::apps {

/// Keeps the order in which keys were added.
using Json = nlohmann::ordered_json;

/// @return program, version, verb, seed, threads and every option of the verb: as given, else its
/// default
Json settings_of(const CLI::App& verb, const Context& context);

/// @return width, height, fx, fy, cx, cy
Json to_json(const Intrinsics& intrinsics);

/// @return points, how many of them were observed and outpainted, and the box they fill, metres
Json summary_of(const Cloud& cloud);

/// @brief Writes a text file; it appears whole or not at all. Throws ps::Error.
void write_text(const std::filesystem::path& path, const std::string& text);

/// @brief Writes indented JSON; the file appears whole or not at all. Throws ps::Error.
void write_json(const std::filesystem::path& path, const Json& json);

/// @brief Prints a report on stdout if the user asked for it. Throws ps::Error when that fails.
void print_report(const Context& context, const Json& report);

/// @brief Prints text on stdout. Throws ps::Error when that fails.
void print_text(const std::string& text);

/// Seconds since it was made, to the millisecond.
class Stopwatch {
 public:
  double seconds() const;

 private:
  Instant start_ = now();
};

/// @brief Adds to a report what the run took: seconds.total and peak_memory_mib.
void add_costs(Json& report, const Stopwatch& total);

/// @brief The end of a run that wrote something: prints the report, with costs, if the user asked
/// for it, and says `OUTPUT: WHAT in 1.2 s`. Throws ps::Error as print_report() does.
void end_run(const Context& context, const Json& report, const std::string& output,
             const std::string& what);

}  // namespace ps::apps
