// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: encoded images, checked before a decoder sees them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "libps/core/image.h"

namespace ps {

/// @brief Walks a JPEG's segments, a PNG's chunks or a WebP's, for what decoders let pass: an end
/// that is missing, a size that so short a file cannot fill. Of BMP, PNM, TIFF and EXR it reads the
/// size alone. (OpenCV's own limit, OPENCV_IO_MAX_IMAGE_PIXELS, is read before we could set it.)
/// @return the EXIF block, from its TIFF header on; empty when there is none
/// Throws ps::Error, naming `name`, when the file is truncated, its size is not believable, or it
/// has more than 2^28 pixels.
std::string_view check_image_bytes(std::string_view bytes, const std::string& name);

/// @return whether a PNG or WebP says that it has an alpha channel; of other kinds false
bool has_alpha(std::string_view bytes);

/// @brief cv::imdecode after check_image_bytes(); throws ps::Error where OpenCV fails.
/// @param flags  cv::ImreadModes
cv::Mat decode_image(std::string_view bytes, int flags, const std::string& name);

/// @brief cv::imencode by the extension of `path`, into a file that appears whole or not at all.
void encode_image(const std::filesystem::path& path, const cv::Mat& image);

/// @return 8-bit BGR as OpenCV's encoders take it; clamped and rounded, NaN is 0
cv::Mat3b to_bgr8(const Image& image);

}  // namespace ps
