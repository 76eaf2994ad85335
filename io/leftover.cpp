// SPDX-License-Identifier: BSD-3-Clause
#include "io/leftover.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <fstream>
#include <system_error>
#include <vector>

namespace fs = std::filesystem;

namespace ps {
namespace {

/// Killed, though its parent has not asked for its status yet.
bool is_zombie(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');  // of "123 (name) Z 1 ..."
  return name_end != std::string::npos && text.compare(name_end, 3, ") Z") == 0;
}

/// Another holds a lock on it, or may: nobody can tell where the file system has no locks, or the
/// file is another user's.
bool is_locked(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return true;
  const bool taken = flock(descriptor, LOCK_EX | LOCK_NB) != 0;
  close(descriptor);
  return taken;
}

bool has_ended(pid_t process) {
  return process == getpid() || (kill(process, 0) != 0 && errno == ESRCH) || is_zombie(process);
}

}  // namespace

std::optional<pid_t> process_of(const std::string& name, const std::string& prefix,
                                const std::string& after) {
  if (name.compare(0, prefix.size(), prefix) != 0) return {};
  pid_t process = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + prefix.size(), end, process);
  if (error != std::errc() || process <= 0) return {};
  const std::string begin = prefix + std::to_string(process) + after;
  const bool ours = after.empty() ? name == begin : name.compare(0, begin.size(), begin) == 0;
  return ours ? std::optional<pid_t>(process) : std::nullopt;
}

void remove_leftovers(const fs::path& folder, fs::file_type type,
                      const std::function<std::optional<pid_t>(const std::string&)>& process_of) {
  std::vector<fs::path> leftovers;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const auto process = process_of(entry.path().filename().string());
    if (process && entry.symlink_status(ignored).type() == type && has_ended(*process) &&
        !is_locked(entry.path())) {
      leftovers.push_back(entry.path());
    }
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, ignored);
}

}  // namespace ps
