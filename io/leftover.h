// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room and the program: what processes left that were killed while they wrote.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace ps {

/// @brief The process that a name is of: "OUT.partial-123" of the prefix "OUT.partial-" is 123's.
/// @param after  what follows the number: anything from there on, or, when empty, nothing
std::optional<pid_t> process_of(const std::string& name, const std::string& prefix,
                                const std::string& after = "");

/// @brief Removes what lies in a folder under the name of a process that is no more, unless
/// somebody holds a lock (flock) on it, or the file system has no locks.
///
/// A process of another PID namespace or machine is told by its lock. Our own number is of an
/// earlier process, unless that lock is held. What cannot be removed stays; nothing is thrown.
/// @param type        of what is removed: folders with all that is in them
/// @param process_of  (name) -> the process it is of, or none
void remove_leftovers(const std::filesystem::path& folder, std::filesystem::file_type type,
                      const std::function<std::optional<pid_t>(const std::string&)>& process_of);

}  // namespace ps
