// SPDX-License-Identifier: BSD-3-Clause
#include "apps/part.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

/// Not by the run path: sanitizers stand between us and dlopen(), which would go by theirs.
fs::path path_of(const std::string& part) {
  std::error_code ignored;
  const fs::path folder = program_folder();
  const std::string name = "libpixelsynth_" + part + ".so";
  const fs::path beside = folder / name;
  const fs::path installed = (folder / PS_PARTS / name).lexically_normal();
  for (const fs::path& path : {beside, installed}) {
    if (fs::exists(path, ignored)) return path;
  }
  throw Error(part, name + " is missing", beside.string() + " or " + installed.string());
}

}  // namespace

fs::path program_folder() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

void* address_in_part(const std::string& part, const char* function) {
  const fs::path path = path_of(part);
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);  // and never closed
  void* const address = library != nullptr ? dlsym(library, function) : nullptr;
  if (address == nullptr) throw Error(part, dlerror(), path.string() + " of this version");
  return address;
}

}  // namespace ps::apps
