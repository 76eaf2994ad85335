// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: one reader for each layout of posed frames (posed_frames.h). Each is_*()
// tells from what is there whether data is meant to be of its layout.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "io/posed_frames.h"

namespace ps {

/// A frame and the files it is read from.
struct FrameFiles {
  PosedFrame frame;
  Pose world_from_cam = Pose::Identity();
  Intrinsics lens;  ///< of its own size; load() gives that of the photo
  std::filesystem::path color;
  std::filesystem::path depth;  ///< empty = there is none
};

/// How depth files say metres.
struct DepthCode {
  double scale = 1000;
  float unknown = std::numeric_limits<float>::infinity();  ///< metres; this far and farther
};

/// @return frames that load from these files; depth of another size than its photo is resized, and
/// so is the lens. Throws ps::Error, naming `where`, when there is no frame.
PosedFrames frames_of(const std::string& layout, std::vector<FrameFiles> files,
                      const DepthCode& code, const std::string& where);

/// @return the lens in intrinsics.json of this folder; where there is none, a lens of 640x480
/// pixels, and a line in `assumed` that says so
Intrinsics lens_or(const std::filesystem::path& folder, const Intrinsics& otherwise,
                   std::vector<std::string>& assumed);

bool is_tum_folder(const std::filesystem::path& path);
PosedFrames open_tum_folder(const std::filesystem::path& path, double depth_scale);

bool is_seven_scenes(const std::filesystem::path& path);
PosedFrames open_seven_scenes(const std::filesystem::path& path, double depth_scale);

bool is_realestate10k(const std::filesystem::path& path);
PosedFrames open_realestate10k(const std::filesystem::path& path);

/// @param data  "rooms:SEED:COUNT"
PosedFrames open_room_frames(const std::string& data);

}  // namespace ps
