// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "libps/core/image.h"

namespace ps {

/// What to do with a file in which no pixel has a depth.
enum class NoDepth { refuse, allow };

/// @brief Reads depth: 16-bit PNG (divided by `scale`: 1000 for millimetres, 5000 for TUM), PFM,
/// 32-bit TIFF and EXR (metres, divided by nothing). EXIF orientation is not applied.
/// NaN, infinite and negative values become 0 (unknown).
/// Throws ps::Error when the file is missing, truncated, of another kind (8-bit, colour), when
/// scale is not positive, or, unless that is allowed, when no pixel has a depth.
Depth read_depth(const std::filesystem::path& path, double scale = 1000,
                 NoDepth no_depth = NoDepth::refuse);

/// @brief The same from a file's bytes; `name` stands in messages.
Depth parse_depth(std::string_view bytes, const std::string& name, double scale = 1000,
                  NoDepth no_depth = NoDepth::refuse);

/// @brief Writes 16-bit PNG (depth times scale, rounded; throws beyond 65535) or PFM, by extension.
/// The file appears whole or not at all.
void write_depth(const std::filesystem::path& path, const Depth& depth, double scale = 1000);

}  // namespace ps
