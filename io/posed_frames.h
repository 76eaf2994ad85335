// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libps/geometry/view.h"

namespace ps {

/// What is known of a frame before its images are read.
struct PosedFrame {
  std::string name;  ///< of its photo, for people; no two are equal
  double stamp = 0;  ///< timestamp, or frame number where there is none; rises within a world
  int world = 0;     ///< frames of one world have poses that go together
};

/// @brief Frames with poses, wherever they come from.
struct PosedFrames {
  std::string layout;                ///< "RGB-D folder", "TUM RGB-D", ...
  std::vector<PosedFrame> frames;    ///< one at least, by world, then stamp
  std::size_t skipped = 0;           ///< frames that lack a photo, a depth or a pose
  std::vector<std::string> assumed;  ///< what the data does not say, and what is taken instead
  /// The pose of frame i, world_from_cam. Of rooms it is built when it is asked for, which is
  /// quickest when frames of one world come one after another. Threads may call it at once.
  std::function<Pose(std::size_t)> pose;
  /// Reads frame i. Its depth is empty where the layout has none; 0 where a pixel is unknown, which
  /// may be everywhere. Threads may call it at once. Throws ps::Error when a file is unsound.
  std::function<View(std::size_t)> load;
};

/// @return whether any pixel of a frame has a depth
bool has_depth(const View& frame);

/// @brief Opens frames without loading them; the layout is told from what is there:
///
/// - an RGB-D folder, as io/rgbd_folder.h has it;
/// - TUM RGB-D: rgb.txt, depth.txt, groundtruth.txt. A photo goes with the depth and the pose that
///   are nearest in time, within 0.02 s, as in the benchmark's associate.py; a depth with one photo
///   alone. Depth is metres times 5000. Lens: intrinsics.json if it is there, else that of the
///   sensor's driver (525 pixels of 640x480);
/// - 7-Scenes: frame-000000.color.png, .depth.png, .pose.txt (camera-to-world 4x4), or a folder of
///   such sequences, seq-01, ..., of one world. Depth 65535 is unknown. Lens: intrinsics.json if it
///   is there, else the 585 pixels of 640x480 that the data set gives;
/// - RealEstate10K: a text file of 19 columns, and the photos in the folder that has its name
///   without .txt, in `frames/` beside it, or beside it; named by timestamps, or as many as lines.
///   DATA is the file, or a folder with one such file. It has no depth;
/// - `rooms:SEED:COUNT`: COUNT views of 256x256 pixels of procedural rooms (libps/rooms), four of
/// each
///   room, of which the second to the fourth are turned by up to 60 degrees and moved by up to a
///   metre from the first. Exact, without camera effects. The rooms are those of `train data --seed
///   SEED`: take a seed that nothing was trained on. A room is built when one of its frames is
///   asked for.
/// @param depth_scale  units of depth images in a metre; empty = as the layout has it
/// Throws ps::Error when `data` is none of these, when what they name is missing, or when no frame
/// has all that its layout promises.
PosedFrames open_posed_frames(const std::string& data, std::optional<double> depth_scale = {});

}  // namespace ps
