// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/report.h"
#include "libps/scene/scene_builder.h"

namespace ps::apps {

/// @brief What an interrupted `scene` has done so far, in the folder `OUT.work` beside its output:
/// one file for each outpainted view, and what they were made from.
class SceneWork {
 public:
  /// @param settings  of the run
  /// @param inputs    files that decide the result: their bytes count
  /// @param resume    whether to go on with what is there; else that is removed
  /// Throws ps::Error when what is there was made from something else.
  SceneWork(const std::filesystem::path& output, const Json& settings,
            const std::vector<std::filesystem::path>& inputs, bool resume);
  ~SceneWork();  ///< removes the folder when there is no view in it
  SceneWork(const SceneWork&) = delete;
  SceneWork& operator=(const SceneWork&) = delete;

  /// @brief What an earlier run made of this view: colour, depth, pixels, and its report.
  /// @return whether it came that far
  bool load(std::size_t number, SupportView& support, Json& report) const;
  void save(std::size_t number, const SupportView& support, const Json& report);
  /// Removes the folder: the scene is complete.
  void finish();

 private:
  std::filesystem::path file(std::size_t number) const;

  std::filesystem::path folder_;
};

}  // namespace ps::apps
