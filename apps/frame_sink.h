// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "libps/geometry/camera.h"
#include "libps/geometry/splat.h"

namespace ps::apps {

/// What `render` writes, and where.
struct SinkOptions {
  double frames_per_second = 30;  ///< of a video
  bool depth = false;             ///< also write depth, 16-bit PNG in millimetres
};

/// Where rendered frames go; what was not finished is removed.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  virtual void add(const Splat& frame) = 0;
  /// Puts everything in its place.
  /// @param poses  of the frames that were added
  virtual void finish(const std::vector<Pose>& poses, const Intrinsics& lens) = 0;
};

/// @brief A sink by the path's name: `.mp4` a video, `.png` one picture, anything else a folder of
/// frame_00000.png (and depth_00000.png), trajectory.txt and intrinsics.json. Throws ps::Error, and
/// CLI::ValidationError for another kind of file.
std::unique_ptr<FrameSink> make_frame_sink(const std::filesystem::path& path, cv::Size size,
                                           const SinkOptions& options);

/// What it calls for a video, in the part `video` of the program (part.h); the caller owns the
/// sink.
extern "C" FrameSink* pixelsynth_video_sink(const std::filesystem::path& path, const cv::Size& size,
                                            double frames_per_second);

}  // namespace ps::apps
