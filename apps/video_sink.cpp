// SPDX-License-Identifier: BSD-3-Clause
#include "apps/frame_sink.h"
#include "io/video.h"

namespace ps::apps {
namespace {

class VideoSink : public FrameSink {
 public:
  VideoSink(const std::filesystem::path& path, cv::Size size, double frames_per_second)
      : writer_(path, size, frames_per_second) {}

  void add(const Splat& frame) override { writer_.add(frame.color); }
  void finish(const std::vector<Pose>&, const Intrinsics&) override { writer_.close(); }

 private:
  VideoWriter writer_;
};

}  // namespace

FrameSink* pixelsynth_video_sink(const std::filesystem::path& path, const cv::Size& size,
                                 double frames_per_second) {
  return new VideoSink(path, size, frames_per_second);
}

}  // namespace ps::apps
