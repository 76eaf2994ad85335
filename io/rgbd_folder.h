// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libps/geometry/view.h"

namespace ps {

/// One frame of an RGB-D folder: where its files are, and its pose.
struct RgbdFrame {
  std::filesystem::path color;
  std::filesystem::path depth;  ///< empty when it was not asked for
  double timestamp = 0;
  Pose world_from_cam = Pose::Identity();
};

/// @brief A folder with `color/`, `depth/`, `trajectory.txt` and `intrinsics.json` (DESIGN.md).
struct RgbdFolder {
  std::filesystem::path path;
  Intrinsics intrinsics;
  std::vector<RgbdFrame> frames;  ///< by timestamp; each has colour, depth and pose
};

/// @brief Lists a folder without loading its images. A trajectory's timestamp names the files: the
/// file whose stem is that number, else, when counts agree, files in order of their names (frame2
/// before frame10).
/// Throws ps::Error when a part is missing or no frame has all three. Frames that lack a file or a
/// pose are left out and counted in `skipped` when it is given.
/// @param with_depth  false: `depth/` is not looked at and need not be there
RgbdFolder open_rgbd_folder(const std::filesystem::path& path, std::size_t* skipped = nullptr,
                            bool with_depth = true);

/// What is odd about a frame, and no error.
struct FrameNotes {
  bool scaled = false;         ///< the depth was of another size, and is resized
  bool without_depth = false;  ///< no pixel has a depth; the view is then empty
};

/// @brief Loads one frame; depth of another size but the same aspect is resized (nearest), of
/// another aspect is an Error. Depth in the file is metres times depth_scale. A frame that was
/// listed without depth is all unknown, which is no error.
/// @param notes  filled, if given; without it, a frame without any depth is an Error
View load_frame(const RgbdFolder& folder, const RgbdFrame& frame, double depth_scale = 1000,
                FrameNotes* notes = nullptr);

}  // namespace ps
