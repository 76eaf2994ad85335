// SPDX-License-Identifier: BSD-3-Clause
#include "io/video.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/image_bytes.h"
#include "io/mp4.h"
#include "io/text.h"

namespace ps {

namespace {

/// What the encoder asks of the disk at a time is less.
constexpr std::size_t kRoom = 1 << 20;

/// The encoder does not say why it failed: throws ps::Error when the disk or a limit is why.
std::string finished(const AtomicFile& file, const std::string& name) try {
  return index_first(std::string(FileBytes(file.temporary()).view()), name);
} catch (const Error&) {
  file.check_room(kRoom);
  throw;
}

}  // namespace

struct VideoWriter::Impl {
  AtomicFile file;
  std::string name;
  cv::Size size;
  cv::VideoWriter encoder;
  std::size_t frames = 0;
};

VideoWriter::VideoWriter(const std::filesystem::path& path, cv::Size size, double rate) {
  const std::string name = path.string();
  guarded(name, [&] {
    if (extension_of(path) != ".mp4") throw Error(name, "is no MP4 by its name", ".mp4");
    if (size.width < 2 || size.height < 2 || size.width > 1 << 14 || size.height > 1 << 14) {
      throw Error(name,
                  "frames of " + std::to_string(size.width) + "x" + std::to_string(size.height),
                  "2 to 16384 pixels a side");
    }
    if (!(rate >= 1 && rate <= 1000)) {
      throw Error(name, std::to_string(rate) + " frames a second", "1 to 1000");
    }
    impl_.reset(new Impl{AtomicFile(path), name, size, {}});
    const cv::Size even((size.width + 1) / 2 * 2, (size.height + 1) / 2 * 2);
    impl_->encoder.open(impl_->file.temporary().string(), cv::CAP_FFMPEG,
                        cv::VideoWriter::fourcc('a', 'v', 'c', '1'), rate, even);
    if (!impl_->encoder.isOpened()) {
      impl_->file.check_room(kRoom);
      throw Error(name, "OpenCV has no H.264 encoder for it", "OpenCV with FFmpeg and libx264");
    }
  });
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image& frame) {
  if (!impl_) throw Error("video", "a frame after the end", "frames before close()");
  guarded(impl_->name, [&] {
    if (frame.size() != impl_->size)
      throw Error(impl_->name, "a frame of another size", "one size");
    cv::Mat bgr = to_bgr8(frame);
    cv::copyMakeBorder(bgr, bgr, 0, bgr.rows % 2, 0, bgr.cols % 2, cv::BORDER_REPLICATE);
    impl_->encoder.write(bgr);
    ++impl_->frames;
  });
}

void VideoWriter::close() {
  if (!impl_) return;
  const std::unique_ptr<Impl> impl = std::move(impl_);
  guarded(impl->name, [&] {
    impl->encoder.release();
    if (impl->frames == 0) throw Error(impl->name, "the video has no frame", "one at least");
    // As many bytes as before: they replace what the encoder wrote.
    impl->file.write(finished(impl->file, impl->name));
    impl->file.commit();
  });
}

}  // namespace ps
