// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "libps/core/image.h"

namespace ps {

/// @brief Writes an MP4 that plays in a browser: H.264, 4:2:0, even size (an odd last row or column
/// is repeated), index in front. The file appears when close() succeeds, or not at all.
class VideoWriter {
 public:
  /// Throws ps::Error when no H.264 encoder is there, the path cannot be written or does not end in
  /// .mp4, a side is not 2 to 16384 pixels, or the rate not 1 to 1000.
  VideoWriter(const std::filesystem::path& path, cv::Size size, double frames_per_second = 30);
  ~VideoWriter();  ///< removes what was not closed

  /// Throws ps::Error when the frame is of another size than the video.
  void add(const Image& frame);
  /// Throws ps::Error when there is no frame or the disk is full. A second call does nothing.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ps
