// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "libps/geometry/scene_cloud.h"

namespace ps {

/// @brief Where fuse() gets its views from, one at a time, so that memory holds few of them.
struct ViewSource {
  std::size_t count = 0;
  /// Loads view i, or an empty view where there is nothing to add. Called in order, once for each
  /// i, never twice at a time, but on another thread than fuse() runs on and while that adds a view
  /// or reports progress.
  std::function<View(std::size_t)> load;
};

struct FuseOptions {
  SceneCloudOptions cloud;
  /// Remove points that other views see through as often as views support them.
  bool remove_contradicted = true;
};

struct FuseReport {
  std::size_t views = 0;         ///< added
  std::size_t empty = 0;         ///< passed over, as they are empty
  AddReport pixels;              ///< summed over the views
  std::size_t contradicted = 0;  ///< points removed at the end
  std::size_t points = 0;        ///< in the cloud
  double load_seconds = 0;       ///< waiting for views
  double add_seconds = 0;
};

/// @brief Fuses posed RGB-D views into one deduplicated cloud with a SceneCloud: world frame of the
/// poses, metres; Point.view is the index of the view in the source (averages after Keller et al.,
/// 3DV 2013). The order of the views matters to the bytes, not to the surface.
/// @param report  filled, if given
/// @param progress  called after each view with (done, count); returning false stops with a
/// ps::Error
/// Throws ps::Error for more than 65536 views and unsound ones; errors of load() are passed on.
Cloud fuse(const ViewSource& source, const FuseOptions& options = {}, FuseReport* report = nullptr,
           const std::function<bool(std::size_t, std::size_t)>& progress = {});

}  // namespace ps
