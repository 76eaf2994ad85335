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
  /// EXIF focal length in pixels of this image (from FocalLengthIn35mmFilm, as
  /// intrinsics_from_focal_35mm(), or from FocalLength and the focal plane's resolution); empty
  /// when the file does not say.
  std::optional<double> focal_px;
  /// What the file tells of its focal length instead, for messages; empty where it tells nothing.
  std::string focal_doubt;
};

/// @brief Reads JPEG, PNG, TIFF, WebP, BMP and PNM; grey and alpha become RGB; 8 and 16 bit.
/// Throws ps::Error when the file is missing, empty, truncated or no such image, or has more than
/// 2^28 pixels.
Photo read_photo(const std::filesystem::path& path);

/// @brief The same from a file's bytes; `name` stands in messages.
Photo parse_photo(std::string_view bytes, const std::string& name);

/// @brief Writes 8-bit PNG or JPEG, by extension; values are clamped to [0,1] and rounded.
/// The file appears whole or not at all.
void write_image(const std::filesystem::path& path, const Image& image);

}  // namespace ps
