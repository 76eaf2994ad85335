// SPDX-License-Identifier: BSD-3-Clause
#include "io/depth_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/image_bytes.h"
#include "io/text.h"

namespace ps {
namespace {

/// OpenCV asks for this before it reads EXR. Set before main(), as threads may read the
/// environment.
[[maybe_unused]] const bool kExrEnabled = setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0) == 0;

/// The next word of a PFM header, and the one blank after it; empty when there is none.
std::string_view pfm_word(std::string_view& rest) {
  const std::size_t end = rest.substr(0, 64).find_first_of(" \t\r\n");
  if (end == std::string_view::npos) return {};
  const std::string_view word = rest.substr(0, end);
  const bool crlf = rest.substr(end, 2) == "\r\n";
  rest.remove_prefix(end + (crlf ? 2 : 1));
  return word;
}

/// Portable float map (Debevec): `Pf`, width, height, scale whose sign is the byte order, rows from
/// the bottom up.
Depth parse_pfm(std::string_view bytes, const std::string& name) {
  std::string_view rest = bytes;
  if (pfm_word(rest) != "Pf") throw Error(name, "is a colour PFM", "one channel (Pf)");
  const auto width = to_number<int>(pfm_word(rest)), height = to_number<int>(pfm_word(rest));
  const auto scale = to_number<double>(pfm_word(rest));
  if (!width || !height || !scale || *width <= 0 || *height <= 0 || !(std::abs(*scale) > 0)) {
    throw Error(name, "the PFM header is unsound", "Pf, width, height and scale");
  }
  const std::uint64_t pixels = static_cast<std::uint64_t>(*width) * *height;
  if (pixels > rest.size() / sizeof(float)) {
    throw Error(name,
                "holds " + std::to_string(rest.size() / sizeof(float)) + " of " +
                    std::to_string(pixels) + " pixels",
                "the whole PFM");
  }
  Depth depth(*height, *width);
  const char* at = rest.data();
  for (int y = *height - 1; y >= 0; --y) {
    for (int x = 0; x < *width; ++x, at += sizeof(float)) {
      depth(y, x) = load<float>(at, *scale > 0);
    }
  }
  return depth;
}

Depth decode_depth(std::string_view bytes, const std::string& name, double scale) {
  const cv::Mat stored =
      decode_image(bytes, cv::IMREAD_UNCHANGED | cv::IMREAD_IGNORE_ORIENTATION, name);
  if (stored.type() == CV_32FC1) return stored;
  if (stored.channels() != 1) throw Error(name, "has colours", "one channel of depth");
  if (stored.type() != CV_16UC1) {
    throw Error(name, stored.depth() == CV_8U ? "has 8 bits" : "has an unknown kind of pixel",
                "16-bit integers or 32-bit floats");
  }
  Depth depth(stored.size());
  // Not convertTo(): it multiplies by the rounded 1 / scale.
  for (int y = 0; y < depth.rows; ++y) {
    const auto* from = stored.ptr<unsigned short>(y);
    std::transform(from, from + depth.cols, depth[y],
                   [scale](unsigned short value) { return static_cast<float>(value / scale); });
  }
  return depth;
}

void write_pfm(const std::filesystem::path& path, const Depth& depth) {
  AtomicFile file(path);
  file.write("Pf\n" + std::to_string(depth.cols) + " " + std::to_string(depth.rows) + "\n-1\n");
  for (int y = depth.rows - 1; y >= 0; --y) file.write(depth[y], depth.cols * sizeof(float));
  file.commit();
}

void write_png(const std::filesystem::path& path, const Depth& depth, double scale) {
  cv::Mat1w stored(depth.size());
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const double value = std::round(depth(y, x) * scale);
      if (value > 65535 && std::isfinite(value)) {
        throw Error(path.string(),
                    std::to_string(depth(y, x)) + " m does not fit 16 bits at scale " +
                        std::to_string(scale),
                    "a smaller scale, or .pfm");
      }
      stored(y, x) = value > 0 && value <= 65535 ? static_cast<unsigned short>(value) : 0;
    }
  }
  encode_image(path, stored);
}

void check_scale(double scale, const std::string& name) {
  if (scale > 0 && std::isfinite(scale)) return;
  throw Error(name, "depth scale " + std::to_string(scale), "a positive number");
}

}  // namespace

Depth parse_depth(std::string_view bytes, const std::string& name, double scale, NoDepth no_depth) {
  return guarded(name, [&] {
    check_scale(scale, name);
    const bool pfm = bytes.substr(0, 2) == "Pf" || bytes.substr(0, 2) == "PF";
    Depth depth = pfm ? parse_pfm(bytes, name) : decode_depth(bytes, name, scale);
    bool any = false;
    for (int y = 0; y < depth.rows; ++y) {
      for (float* d = depth[y]; d != depth[y] + depth.cols; ++d) {
        if (!(*d > 0 && std::isfinite(*d))) *d = 0;
        any = any || *d > 0;
      }
    }
    if (!any && no_depth == NoDepth::refuse) {
      throw Error(name, "no pixel has a depth", "at least one that is not 0");
    }
    return depth;
  });
}

Depth read_depth(const std::filesystem::path& path, double scale, NoDepth no_depth) {
  return guarded(path.string(), [&] {
    return parse_depth(FileBytes(path).view(), path.string(), scale, no_depth);
  });
}

void write_depth(const std::filesystem::path& path, const Depth& depth, double scale) {
  guarded(path.string(), [&] {
    check_scale(scale, path.string());
    if (depth.empty()) throw Error(path.string(), "the depth has no pixels", "at least one");
    const std::string extension = extension_of(path);
    if (extension == ".pfm") return write_pfm(path, depth);
    if (extension == ".png") return write_png(path, depth, scale);
    throw Error(path.string(), "cannot write " + in_quotes(extension), ".png or .pfm");
  });
}

}  // namespace ps
