// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace ps::apps {

/// @brief The folder `NAME.partial-PID` that an output is made in; it goes with the object, unless
/// it was renamed. A lock on it tells other runs that this one lives.
class PartialFolder {
 public:
  /// Makes it, and first removes folders of this NAME and this naming whose processes are no more.
  /// @param parent  an existing folder
  /// Throws ps::Error when it is there already and in use, std::filesystem::filesystem_error when
  /// it cannot be made.
  PartialFolder(const std::filesystem::path& parent, const std::string& name);
  ~PartialFolder();
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace ps::apps
