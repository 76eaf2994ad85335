// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "libps/geometry/point.h"

namespace ps {

/// @brief Reads PLY or PCD, by extension. Throws ps::Error when it is neither, and as they do.
Cloud read_cloud(const std::filesystem::path& path);

/// @brief Writes PLY or PCD, by extension. The file appears whole or not at all.
void write_cloud(const std::filesystem::path& path, const Cloud& cloud);

}  // namespace ps
