// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/context.h"
#include "apps/frame_list.h"
#include "apps/report.h"
#include "io/posed_frames.h"

namespace ps::apps {

/// DATA, and which of its frames.
struct FramesArguments {
  std::string data;
  std::string frames;
  FrameChoice choice;
  std::optional<double> depth_scale;

  /// @param standard  what is taken when DATA is not given, for the help; empty = it must be
  void add_to(CLI::App& verb, const std::string& standard = "");
};

/// Frames with poses, some of them chosen.
struct ChosenFrames {
  PosedFrames all;
  std::vector<std::size_t> chosen;  ///< indices into all.frames
  /// Of each chosen frame, for bootstrap_mean(): its world, or of one world a twentieth of the
  /// walk, as neighbours on it see the same things.
  std::vector<int> groups;

  std::vector<int> worlds() const;  ///< of each chosen frame
  const std::string& name(std::size_t chosen_frame) const {
    return all.frames[chosen[chosen_frame]].name;
  }
  Pose pose(std::size_t chosen_frame) const { return all.pose(chosen[chosen_frame]); }
  View load(std::size_t chosen_frame) const { return all.load(chosen[chosen_frame]); }
};

/// @brief Opens DATA and chooses; warns of what is left out or assumed. Throws ps::Error, also when
/// no frame is left, and CLI::ValidationError for a range that is none.
ChosenFrames choose_posed_frames(const FramesArguments& arguments, const Context& context);

/// @return for reports: data, layout, frames, skipped, assumed
Json frames_report(const FramesArguments& arguments, const ChosenFrames& frames);

}  // namespace ps::apps
