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
/// are replaced, a numbered file (frame_00012.png) of an earlier, longer run is removed, so is what
/// clears() names, and all others stay. It first checks that no file would have to replace a folder
/// or a folder a file.
class OutputFolder {
 public:
  /// Throws ps::Error when the target is a file, a link to nothing or the root folder, or when its
  /// parent is missing or cannot be written; CLI::ValidationError when its name is empty.
  explicit OutputFolder(const std::filesystem::path& target);

  /// Makes the folder of a file of this relative name, and has `task` write it where it is told to.
  /// A ps::Error of the task leaves with the place that the file would have had.
  void write(const std::string& name,
             const std::function<void(const std::filesystem::path&)>& task);
  /// @brief Names files that only a run of this kind writes: commit() removes those of them that
  /// this run did not write, as they are of an earlier run that was asked for other things.
  /// @param names  relative; "telea/pair_#.png" is that series of numbered files
  void clears(const std::vector<std::string>& names);
  /// @brief Fails before the work: throws ps::Error where a file of one of these relative names
  /// would meet a folder, or one of its folders a file.
  void check_places(const std::vector<std::string>& names) const;
  void commit();  ///< throws ps::Error

 private:
  std::string shown(const std::filesystem::path& path) const;
  void clear_stale() const;

  std::filesystem::path given_;           ///< the target as the user wrote it, for messages
  std::filesystem::path target_;          ///< the same, absolute
  std::optional<PartialFolder> partial_;  ///< always there; removes what was not committed
  std::vector<std::string> stale_;        ///< names that clears() was given
};

/// @brief Fails before the work, not after it: throws CLI::ValidationError unless `path` has one of
/// the extensions (with their dots; empty = any), and ps::Error unless it is no folder and lies in
/// a folder that can be written.
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
