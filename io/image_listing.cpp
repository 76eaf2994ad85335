// SPDX-License-Identifier: BSD-3-Clause
#include "io/image_listing.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "io/text.h"
#include "libps/core/error.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

bool digit(char c) { return c >= '0' && c <= '9'; }

std::string size_of(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

bool is_image(const fs::directory_entry& entry) {
  static const std::string kKinds = " .png .jpg .jpeg .bmp .webp .tif .tiff .ppm .pgm .pfm .exr ";
  const std::string extension = extension_of(entry.path());
  const bool hidden = entry.path().filename().string().front() == '.';
  const bool kind = !extension.empty() && kKinds.find(" " + extension + " ") != std::string::npos;
  return kind && !hidden && entry.is_regular_file();
}

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && digit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string x = number(a, i), y = number(b, j);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  return a.size() - i < b.size() - j || (a.size() - i == b.size() - j && a < b);
}

ImageListing::ImageListing(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw Error(folder.string(), "is no folder", "a folder of images");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_image(entry)) files.push_back(entry.path());
  }
  if (files.empty()) throw Error(folder.string(), "holds no image", "one for each frame");
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  for (const fs::path& file : files) {
    const std::optional<double> number = to_number<double>(file.stem().string());
    if (!number || !std::isfinite(*number)) continue;
    if (!by_number.emplace(*number, file).second) {
      throw Error(file.string(), "another image has its number", "one for each frame");
    }
  }
}

const fs::path* ImageListing::find(double timestamp) const {
  const auto found = by_number.find(timestamp);
  return found == by_number.end() ? nullptr : &found->second;
}

Depth fitted_depth(const Depth& depth, cv::Size size, const std::string& where) {
  if (!same_aspect(depth.size(), size)) {
    throw Error(where, "depth is " + size_of(depth.size()) + ", the photo " + size_of(size),
                "the same aspect");
  }
  if (depth.size() == size) return depth;
  Depth fitted;
  cv::resize(depth, fitted, size, 0, 0, cv::INTER_NEAREST_EXACT);
  return fitted;
}

Intrinsics fitted_lens(const Intrinsics& lens, cv::Size size, const std::string& where) {
  const cv::Size camera(lens.width, lens.height);
  if (!same_aspect(camera, size)) {
    throw Error(where,
                "the photo is " + size_of(size) + ", the intrinsics are for " + size_of(camera),
                "the same aspect");
  }
  return camera == size ? lens : resized(lens, size.width, size.height);
}

}  // namespace ps
