// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: numbers of a JSON file.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/text.h"
#include "libps/core/error.h"

namespace ps {

/// @brief Parses JSON. Throws ps::Error, naming `name`, when it is none, nests deeper than 8 or
/// says a key twice.
inline nlohmann::json parse_json_text(std::string_view text, const std::string& name) {
  using Json = nlohmann::json;
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > 8) throw Error(name, "the JSON nests too deep", "a flat file");
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second) {
      throw Error(name, "the JSON says a key twice: " + in_quotes(value.get<std::string>()),
                  "it once");
    }
    return true;
  };
  try {
    return Json::parse(text, watch);
  } catch (const Json::exception& error) {
    throw Error(name, std::string("is no sound JSON: ") + in_quotes(error.what()), "JSON");
  }
}

}  // namespace ps
