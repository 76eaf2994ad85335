// SPDX-License-Identifier: BSD-3-Clause
#include "apps/frame_sink.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>

#include "apps/output.h"
#include "apps/part.h"
#include "io/atomic_file.h"
#include "io/depth_file.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "io/trajectory.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

/// Depth of the blended surface; what 16 bits of millimetres cannot hold becomes unknown.
void write_depth_png(const fs::path& path, const Splat& frame) {
  constexpr double kFarthest = 65.535;
  Depth depth = frame.expected_depth.clone();
  depth.setTo(0, depth > kFarthest);
  write_depth(path, depth);
}

class FolderSink : public FrameSink {
 public:
  FolderSink(const fs::path& path, const SinkOptions& options) : folder_(path), options_(options) {}

  void add(const Splat& frame) override {
    char number[16];
    std::snprintf(number, sizeof number, "%05zu.png", count_++);
    folder_.write(std::string("frame_") + number,
                  [&](const fs::path& file) { write_image(file, frame.color); });
    if (options_.depth) {
      folder_.write(std::string("depth_") + number,
                    [&](const fs::path& file) { write_depth_png(file, frame); });
    }
  }

  void finish(const std::vector<Pose>& poses, const Intrinsics& lens) override {
    std::vector<StampedPose> stamped;
    for (const Pose& pose : poses) {
      stamped.push_back({static_cast<double>(stamped.size()), pose, "", {}});
    }
    folder_.write("trajectory.txt", [&](const fs::path& file) { write_trajectory(file, stamped); });
    folder_.write("intrinsics.json", [&](const fs::path& file) { write_intrinsics(file, lens); });
    folder_.commit();
  }

 private:
  OutputFolder folder_;
  SinkOptions options_;
  std::size_t count_ = 0;
};

class PictureSink : public FrameSink {
 public:
  PictureSink(const fs::path& path, const SinkOptions& options) : path_(path), options_(options) {
    check_output_file(path, {".png"});
    if (options.depth) check_output_file(beside(path, "depth.png"), {});
  }

  void add(const Splat& frame) override { frame_ = frame; }

  void finish(const std::vector<Pose>&, const Intrinsics&) override {
    AtomicFiles files;
    write_image(path_, frame_.color);
    if (options_.depth) write_depth_png(beside(path_, "depth.png"), frame_);
    files.commit();
  }

 private:
  fs::path path_;
  SinkOptions options_;
  Splat frame_;
};

}  // namespace

std::unique_ptr<FrameSink> make_frame_sink(const fs::path& path, cv::Size size,
                                           const SinkOptions& options) {
  static const std::array<const char*, 8> kOthers = {".avi", ".mkv", ".mov",  ".webm",
                                                     ".gif", ".jpg", ".jpeg", ".ply"};
  const std::string extension = extension_of(path);
  if (extension == ".png") return std::make_unique<PictureSink>(path, options);
  if (extension == ".mp4") {
    check_output_file(path, {".mp4"});
    const auto video_sink =
        function_of_part<decltype(pixelsynth_video_sink)>("video", "pixelsynth_video_sink");
    return std::unique_ptr<FrameSink>(video_sink(path, size, options.frames_per_second));
  }
  if (std::find(kOthers.begin(), kOthers.end(), extension) != kOthers.end()) {
    throw CLI::ValidationError(path.string(),
                               "is no kind of file that can be written here; expected a name "
                               "ending in .mp4 or .png, or a folder");
  }
  return std::make_unique<FolderSink>(path, options);
}

}  // namespace ps::apps
