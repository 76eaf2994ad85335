// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: what a photo says of its making.
#pragma once

#include <opencv2/core/types.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace ps {

/// What a photo's EXIF says that matters here (CIPA DC-008).
struct Exif {
  int orientation = 1;       ///< 1 to 8; 1 = upright
  double focal_35mm = 0;     ///< FocalLengthIn35mmFilm; 0 = unknown
  double focal_mm = 0;       ///< FocalLength; 0 = unknown
  double pixels_per_mm = 0;  ///< FocalPlaneXResolution; 0 = unknown
  double width = 0;          ///< PixelXDimension, before any later resizing; 0 = unknown

  /// @param size  of the image in the file, before it is turned upright
  /// @return the focal length in pixels; empty when unknown or not believable
  std::optional<double> focal_px(cv::Size size) const;
  /// @return what it tells of the focal length where focal_px() is empty, and why that is no help:
  /// "a focal length of 0.1 mm, which cannot be"; empty when it tells nothing
  std::string focal_doubt(cv::Size size) const;
};

/// @param tiff  the block from its TIFF header on, as check_image_bytes() returns it; may be empty
/// or damaged: what cannot be read stays unknown
Exif parse_exif(std::string_view tiff);

}  // namespace ps
