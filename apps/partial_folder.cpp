// SPDX-License-Identifier: BSD-3-Clause
#include "apps/partial_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <system_error>

#include "io/leftover.h"
#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

/// @return what holds a lock on a folder, which ends with this process; -1 = there are no locks
int locked(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0 || flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  close(descriptor);
  return -1;
}

}  // namespace

PartialFolder::PartialFolder(const fs::path& parent, const std::string& name) {
  const std::string prefix = name + ".partial-";
  remove_leftovers(parent, fs::file_type::directory,
                   [&](const std::string& found) { return process_of(found, prefix); });
  const fs::path path = parent / (prefix + std::to_string(getpid()));
  if (!fs::create_directory(path)) {
    throw Error(path.string(), "is there already, of another run", "another output");
  }
  path_ = path;
  lock_ = locked(path_);
}

PartialFolder::~PartialFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (lock_ >= 0) close(lock_);
}

}  // namespace ps::apps
