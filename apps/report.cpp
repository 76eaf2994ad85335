// SPDX-License-Identifier: BSD-3-Clause
#include "apps/report.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

#include "apps/peak_memory.h"
#include "io/atomic_file.h"
#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps::apps {
namespace {

/// A number where the text is one, else the text.
Json value_of(const std::string& text) {
  const Json value = Json::parse(text, nullptr, false);
  return value.is_number() || value.is_boolean() ? value : Json(text);
}

Json value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return option.count() > 0;  // a flag
  const std::vector<std::string> given = option.results();
  if (given.empty()) {
    const std::string& otherwise = option.get_default_str();
    return otherwise.empty() ? Json() : value_of(otherwise);
  }
  if (option.get_items_expected_max() == 1 && given.size() == 1) return value_of(given.front());
  Json values = Json::array();
  for (const std::string& value : given) values.push_back(value_of(value));
  return values;
}

/// "eval depth"
std::string full_name(const CLI::App& verb) {
  const CLI::App* group = verb.get_parent();
  const bool nested = group != nullptr && group->get_parent() != nullptr;
  return (nested ? group->get_name() + " " : "") + verb.get_name();
}

/// @param where  for the message
void print(const std::string& text, const std::string& where) {
  const bool printed = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (printed && std::fflush(stdout) == 0) return;
  throw Error(where, "cannot be written: " + std::generic_category().message(errno),
              "a terminal or a file that takes it");
}

}  // namespace

Json settings_of(const CLI::App& verb, const Context& context) {
  Json settings;
  settings["program"] = "pixelsynth";
  settings["version"] = PS_VERSION;
  settings["verb"] = full_name(verb);
  settings["seed"] = context.seed;
  settings["threads"] = threads();
  Json& options = settings["options"] = Json::object();
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_single_name();
    if (name != "help") options[name] = value_of(*option);
  }
  return settings;
}

Json to_json(const Intrinsics& k) {
  return {{"width", k.width}, {"height", k.height}, {"fx", k.fx},
          {"fy", k.fy},       {"cx", k.cx},         {"cy", k.cy}};
}

Json summary_of(const Cloud& cloud) {
  std::size_t outpainted = 0;
  Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = Eigen::Vector3f::Zero();
  if (!cloud.empty()) low = high = cloud.front().getVector3fMap();
  for (const Point& point : cloud) {
    outpainted += point.origin == static_cast<std::uint8_t>(Origin::outpainted);
    low = low.cwiseMin(point.getVector3fMap());
    high = high.cwiseMax(point.getVector3fMap());
  }
  Json json;
  json["points"] = cloud.size();
  json["observed"] = cloud.size() - outpainted;
  json["outpainted"] = outpainted;
  json["box_min_m"] = {low.x(), low.y(), low.z()};
  json["box_max_m"] = {high.x(), high.y(), high.z()};
  return json;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

void write_json(const std::filesystem::path& path, const Json& json) {
  write_text(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void print_report(const Context& context, const Json& report) {
  if (!context.json) return;
  const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  print(text, "--json, to stdout");
}

void print_text(const std::string& text) { print(text, "stdout"); }

double Stopwatch::seconds() const { return std::round(seconds_since(start_) * 1000) / 1000; }

void add_costs(Json& report, const Stopwatch& total) {
  report["seconds"]["total"] = total.seconds();
  report["peak_memory_mib"] = peak_memory_mib();
}

void end_run(const Context& context, const Json& report, const std::string& output,
             const std::string& what) {
  print_report(context, report);
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, " in %.1f s", report["seconds"]["total"].get<double>());
  context.say(output + ": " + what + seconds);
}

}  // namespace ps::apps
