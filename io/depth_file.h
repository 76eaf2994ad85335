// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "libps/core/image.h"

namespace ps {

/// @brief Reads depth: 16-bit PNG (divided by `scale`: 1000 for millimetres, 5000 for TUM), PFM,
/// 32-bit TIFF and EXR (metres, divided by nothing).
/// NaN, infinite and negative values become 0 (unknown).
/// Throws ps::Error when the file is missing, truncated, of another kind (8-bit, colour), when
/// scale is not positive, or when no pixel has a depth.
Depth read_depth(const std::filesystem::path& path, double scale = 1000);

/// @brief Writes 16-bit PNG (depth times scale, rounded; throws beyond 65535) or PFM, by extension.
void write_depth(const std::filesystem::path& path, const Depth& depth, double scale = 1000);

}  // namespace ps
