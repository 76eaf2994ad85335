// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "libps/core/image.h"

namespace ps {

/// @brief Writes an MP4 that plays in a browser: H.264, 4:2:0, even size (an odd last row or column is
/// repeated), index in front where the encoder can. The file appears when close() succeeds, or not at all.
class VideoWriter {
 public:
  /// Throws ps::Error when no H.264 encoder is there or the path cannot be written.
  VideoWriter(const std::filesystem::path& path, cv::Size size, double frames_per_second = 30);
  ~VideoWriter();  ///< removes what was not closed

  void add(const Image& frame);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ps
