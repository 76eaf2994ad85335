// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/context.h"
#include "apps/depth_model.h"
#include "apps/frame_list.h"
#include "apps/lens_arguments.h"
#include "apps/report.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/view.h"

namespace ps::apps {

/// What a scene is made from: a photo, two, or a folder of RGB-D frames.
struct SceneInputArguments {
  std::string photo;  ///< or the folder
  std::string depth;
  double depth_scale = 1000;
  LensArguments lens;
  std::string frames;  ///< of a folder
  int every = 1;
  std::string second;        ///< another photo of the place; empty = none
  std::string second_depth;  ///< its depth; empty = estimated
  std::string second_pose = "auto";
  LiftOptions lift;

  void add_to(CLI::App& verb);
  bool is_folder() const;
  bool needs_estimate() const;  ///< whether a photo's depth is not given
  FrameChoice choice() const;   ///< of a folder's frames
  /// @return every file that is read, weights aside
  std::vector<std::filesystem::path> files() const;
};

/// What was observed. A folder's frames are read when they are asked for: none is held.
struct SceneInput {
  View first;                             ///< the scene starts from it
  std::size_t count = 1;                  ///< of views, with the first
  std::function<View(std::size_t)> load;  ///< by number from 0; a frame without depth is empty
  std::function<Depth(std::size_t)> load_depth;  ///< the same's depth alone; null: of photos
  std::size_t without_depth = 0;                 ///< frames before the first, left out
  Json report;                                   ///< what the report says of lens and depth
};

/// @brief Reads photos, or a folder's first frame. Depth that is not given, or has holes, is
/// estimated by `model`.
/// @param model    null = depth must be given
/// @param longest  pixels: a photo with a longer side is shrunk to that before it is lifted
/// Throws ps::Error.
SceneInput read_scene_input(const SceneInputArguments& arguments, const DepthModel* model,
                            int longest, const Context& context);

}  // namespace ps::apps
