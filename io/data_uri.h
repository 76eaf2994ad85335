// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "libps/core/image.h"

namespace ps {

/// @return bytes as base64 with padding (RFC 4648, section 4)
std::string base64(std::string_view bytes);

/// @brief An image as an address that a web page can show without a file: a PNG, or a JPEG of
/// quality 95. Throws ps::Error when the image is empty.
std::string data_uri(const Image& image, bool lossless);

}  // namespace ps
