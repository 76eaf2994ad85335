// SPDX-License-Identifier: BSD-3-Clause
#include "io/photo.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/bytes.h"
#include "io/exif.h"
#include "io/image_bytes.h"
#include "io/text.h"

namespace ps {
namespace {

/// EXIF orientation 1 to 8: where row 0 and column 0 of the file are in the upright image.
cv::Mat upright(const cv::Mat& image, int orientation) {
  cv::Mat out = image;
  if (orientation >= 5) cv::transpose(image, out);
  switch (orientation) {
    case 2:
    case 6:
      cv::flip(out, out, 1);
      break;
    case 3:
    case 7:
      cv::flip(out, out, -1);
      break;
    case 4:
    case 8:
      cv::flip(out, out, 0);
      break;
    default:
      break;
  }
  return out;
}

/// The mean of each square of pixels, as large as leaves what is wanted.
cv::Mat averaged(const cv::Mat& image, WantedPixels wanted) {
  if (wanted.long_side <= 0) return image;
  const auto [shorter, longer] = std::minmax(image.cols, image.rows);
  const int square = std::min(longer / wanted.long_side, shorter / std::max(1, wanted.short_side));
  if (square < 2) return image;
  cv::Mat small;
  cv::resize(image, small, {image.cols / square, image.rows / square}, 0, 0, cv::INTER_AREA);
  return small;
}

/// BGR integers to RGB shares of `white`.
template <class T>
Image to_image(const cv::Mat_<cv::Vec<T, 3>>& bgr, float white) {
  Image out(bgr.size());
  for (int y = 0; y < bgr.rows; ++y) {
    const cv::Vec<T, 3>* from = bgr[y];
    cv::Vec3f* to = out[y];
    for (int x = 0; x < bgr.cols; ++x) {
      to[x] = {from[x][2] / white, from[x][1] / white, from[x][0] / white};
    }
  }
  return out;
}

/// The share of pixels that are not wholly opaque; `image` loses its fourth channel, if it has one.
double take_alpha(cv::Mat& image) {
  if (image.channels() != 4) return 0;
  cv::Mat alpha;
  cv::extractChannel(image, alpha, 3);
  cv::cvtColor(image, image, cv::COLOR_BGRA2BGR);
  const double opaque = alpha.depth() == CV_16U ? 65535 : 255;
  return static_cast<double>(cv::countNonZero(alpha < opaque)) / static_cast<double>(alpha.total());
}

}  // namespace

Photo parse_photo(std::string_view bytes, const std::string& name, WantedPixels wanted) {
  return guarded(name, [&] {
    if (bytes.substr(0, 4) == "\x76\x2f\x31\x01") throw Error(name, "is an EXR", "a photo");
    const Exif exif = parse_exif(check_image_bytes(bytes, name));
    constexpr int kColors = cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION;
    Photo photo;
    cv::Mat stored;
    if (has_alpha(bytes)) {
      stored = decode_image(bytes, cv::IMREAD_UNCHANGED, name);
      photo.transparent = take_alpha(stored);
    }
    if (stored.channels() != 3) stored = decode_image(bytes, kColors, name);
    const cv::Size size = stored.size();
    stored = averaged(stored, wanted);
    const cv::Mat bgr = upright(stored, exif.orientation);
    stored.release();
    photo.size = exif.orientation >= 5 ? cv::Size(size.height, size.width) : size;
    if (bgr.type() == CV_8UC3) {
      photo.color = to_image<unsigned char>(bgr, 255);
    } else if (bgr.type() == CV_16UC3) {
      photo.color = to_image<unsigned short>(bgr, 65535);
    } else {
      throw Error(name, "its pixels are not integers", "8 or 16 bits for each channel");
    }
    photo.focal_px = exif.focal_px(size);
    photo.focal_doubt = exif.focal_doubt(size);
    return photo;
  });
}

Photo read_photo(const std::filesystem::path& path, WantedPixels wanted) {
  return guarded(path.string(),
                 [&] { return parse_photo(FileBytes(path).view(), path.string(), wanted); });
}

void write_image(const std::filesystem::path& path, const Image& image) {
  guarded(path.string(), [&] {
    const std::string extension = extension_of(path);
    if (extension != ".png" && extension != ".jpg" && extension != ".jpeg") {
      throw Error(path.string(), "cannot write " + in_quotes(extension), ".png, .jpg or .jpeg");
    }
    if (image.empty()) throw Error(path.string(), "the image has no pixels", "at least one");
    encode_image(path, to_bgr8(image));
  });
}

}  // namespace ps
