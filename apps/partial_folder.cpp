// SPDX-License-Identifier: BSD-3-Clause
#include "apps/partial_folder.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

/// A lock on a folder, which ends with the process that holds it, wherever that runs.
struct Lock {
  int descriptor = -1;
  bool taken = false;  ///< another holds it, or may

  explicit Lock(const fs::path& folder)
      : descriptor(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {
    if (descriptor < 0 || flock(descriptor, LOCK_EX | LOCK_NB) == 0) return;
    taken = true;  // or the file system has no locks: then nobody can tell
    close(descriptor);
    descriptor = -1;
  }
};

/// "OUT.partial-123" of the prefix "OUT.partial-" is process 123's.
std::optional<pid_t> process_of(const std::string& name, const std::string& prefix) {
  if (name.compare(0, prefix.size(), prefix) != 0) return {};
  pid_t process = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + prefix.size(), end, process);
  const bool exact = error == std::errc() && stop == end && process > 0 &&
                     name == prefix + std::to_string(process);
  return exact ? std::optional<pid_t>(process) : std::nullopt;
}

/// Killed, though its parent has not asked for its status yet.
bool is_zombie(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');  // of "123 (name) Z 1 ..."
  return name_end != std::string::npos && text.compare(name_end, 3, ") Z") == 0;
}

/// A process of another PID namespace or machine is told by its lock; where a file system has no
/// locks, everything is taken to be in use. Our own number is of an earlier process, unless that
/// lock is held.
bool has_ended(pid_t process, const fs::path& folder) {
  const bool lives = process != getpid() && (kill(process, 0) == 0 || errno != ESRCH) &&
                     !is_zombie(process);
  if (lives) return false;
  const Lock lock(folder);
  if (lock.descriptor >= 0) close(lock.descriptor);
  return !lock.taken;
}

void remove_leftovers(const fs::path& parent, const std::string& prefix) {
  std::vector<fs::path> leftovers;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(parent, ignored)) {
    const auto process = process_of(entry.path().filename().string(), prefix);
    if (process && entry.symlink_status(ignored).type() == fs::file_type::directory &&
        has_ended(*process, entry.path())) {
      leftovers.push_back(entry.path());
    }
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, ignored);
}

}  // namespace

PartialFolder::PartialFolder(const fs::path& parent, const std::string& name) {
  const std::string prefix = name + ".partial-";
  remove_leftovers(parent, prefix);
  const fs::path path = parent / (prefix + std::to_string(getpid()));
  if (!fs::create_directory(path)) {
    throw Error(path.string(), "is there already, of another run", "another output");
  }
  path_ = path;
  lock_ = Lock(path_).descriptor;
}

PartialFolder::~PartialFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (lock_ >= 0) close(lock_);
}

}  // namespace ps::apps
