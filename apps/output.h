// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/partial_folder.h"

namespace ps::apps {

/// @brief A folder of outputs that appears when commit() succeeds, or not at all.
///
/// Everything is written into `TARGET.partial-PID` beside it (inside, as `.partial-PID`, where the
/// target is a mount point), and what earlier runs left there when they were killed is removed
/// first. commit() renames that to the target,
/// or, when the target is a folder already, moves its files over one by one: files of the same name
/// are replaced, a numbered file (frame_00012.png) of an earlier, longer run is removed, and all
/// others stay. It first checks that no file would have to replace a folder or a folder a file.
class OutputFolder {
 public:
  /// Throws ps::Error when the target is a file, or when its parent is missing or cannot be
  /// written.
  explicit OutputFolder(const std::filesystem::path& target);

  /// Makes the folder of a file of this relative name, and has `task` write it where it is told to.
  /// A ps::Error of the task leaves with the place that the file would have had.
  void write(const std::string& name,
             const std::function<void(const std::filesystem::path&)>& task);
  void commit();  ///< throws ps::Error

 private:
  std::string shown(const std::filesystem::path& path) const;

  std::filesystem::path given_;           ///< the target as the user wrote it, for messages
  std::filesystem::path target_;          ///< the same, absolute
  std::optional<PartialFolder> partial_;  ///< always there; removes what was not committed
};

/// @brief Fails before the work, not after it: throws ps::Error unless `path` has one of the
/// extensions (with their dots; empty = any), is no folder, and lies in a folder that can be
/// written.
void check_output_file(const std::filesystem::path& path,
                       const std::vector<std::string>& extensions);

/// @brief Throws ps::Error when an output would replace one of the files it is made from, under
/// whatever name.
void check_not_input(const std::filesystem::path& output,
                     const std::vector<std::filesystem::path>& inputs);

/// @return the extension in lower case, with its dot
std::string extension_of(const std::filesystem::path& path);

/// @return `fused.ply`, "report.json" -> `fused.report.json`, in the same folder
std::filesystem::path beside(const std::filesystem::path& path, const std::string& name);

}  // namespace ps::apps
