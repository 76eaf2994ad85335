// SPDX-License-Identifier: BSD-3-Clause
#include "apps/default_weights.h"

#include <array>
#include <system_error>

#include "apps/part.h"
#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

std::array<fs::path, 2> places_of(const std::string& name) {
  return {(program_folder() / PS_WEIGHTS / name).lexically_normal(),
          fs::path(PS_SOURCE_WEIGHTS) / name};
}

}  // namespace

std::optional<fs::path> find_default_weights(const std::string& name) {
  for (const fs::path& path : places_of(name)) {
    std::error_code ignored;
    if (fs::exists(path, ignored)) return path;
  }
  return std::nullopt;
}

fs::path default_weights(const std::string& name) {
  if (const auto path = find_default_weights(name)) return *path;
  const auto [installed, source] = places_of(name);
  throw Error(name, "these weights, which come with the program, are missing",
              installed.string() + " or " + source.string() + ", or --weights FILE");
}

}  // namespace ps::apps
