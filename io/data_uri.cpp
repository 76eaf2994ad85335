// SPDX-License-Identifier: BSD-3-Clause
#include "io/data_uri.h"

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "io/image_bytes.h"
#include "libps/core/error.h"

namespace ps {

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::string data_uri(const Image& image, bool lossless) {
  if (image.empty()) throw Error("data_uri", "the image has no pixels", "at least one");
  std::vector<unsigned char> bytes;
  const std::vector<int> quality = {cv::IMWRITE_JPEG_QUALITY, 95};
  cv::imencode(lossless ? ".png" : ".jpg", to_bgr8(image), bytes,
               lossless ? std::vector<int>() : quality);
  const std::string_view view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return std::string("data:image/") + (lossless ? "png" : "jpeg") + ";base64," + base64(view);
}

}  // namespace ps
