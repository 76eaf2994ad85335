// SPDX-License-Identifier: BSD-3-Clause
#include "apps/default_weights.h"

#include <system_error>

#include "apps/part.h"
#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {

fs::path default_weights(const std::string& name) {
  const fs::path installed = (program_folder() / PS_WEIGHTS / name).lexically_normal();
  const fs::path source = fs::path(PS_SOURCE_WEIGHTS) / name;
  for (const fs::path& path : {installed, source}) {
    std::error_code ignored;
    if (fs::exists(path, ignored)) return path;
  }
  throw Error(name, "these weights, which come with the program, are missing",
              installed.string() + " or " + source.string() + ", or --weights FILE");
}

}  // namespace ps::apps
