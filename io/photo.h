// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "libps/core/image.h"

namespace ps {

/// A photo, turned upright as its EXIF orientation says.
struct Photo {
  Image color;
  cv::Size size;  ///< of the photo; `color` has fewer pixels where fewer were wanted
  /// The share of its pixels that a PNG or WebP calls transparent, wholly or in part, as far as
  /// OpenCV tells (of grey with one transparent value it does not); their stored colours are in
  /// `color` all the same.
  double transparent = 0;
  /// EXIF focal length in pixels of a photo of this size (from FocalLengthIn35mmFilm, as
  /// intrinsics_from_focal_35mm(), or from FocalLength and the focal plane's resolution); empty
  /// when the file does not say.
  std::optional<double> focal_px;
  /// What the file tells of its focal length instead, for messages; empty where it tells nothing.
  std::string focal_doubt;
};

/// How many pixels of a photo are wanted; 0 = all along the long side.
struct WantedPixels {
  int long_side = 0, short_side = 1;
};

/// @brief Reads JPEG, PNG, TIFF, WebP, BMP and PNM; grey and alpha become RGB; 8 and 16 bit.
/// Throws ps::Error when the file is missing, empty, truncated or no such image, or has more than
/// 2^28 pixels.
/// @param wanted  of a photo of twice as many or more, along both sides, squares of pixels are
/// averaged as it is read: as large squares as leave so many, so that it is never held whole in
/// floats
Photo read_photo(const std::filesystem::path& path, WantedPixels wanted = {});

/// @brief The same from a file's bytes; `name` stands in messages.
Photo parse_photo(std::string_view bytes, const std::string& name, WantedPixels wanted = {});

/// @brief Writes 8-bit PNG or JPEG, by extension; values are clamped to [0,1] and rounded.
/// The file appears whole or not at all.
void write_image(const std::filesystem::path& path, const Image& image);

}  // namespace ps
