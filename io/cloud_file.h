// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "libps/geometry/point.h"

namespace ps {

/// @brief Reads PLY or PCD, by extension. Throws ps::Error when it is neither, and as they do.
Cloud read_cloud(const std::filesystem::path& path);

/// @brief Writes PLY or PCD, by extension. The file appears whole or not at all.
/// @param up  the world's axis that points up, which PLY notes; empty = not known
void write_cloud(const std::filesystem::path& path, const Cloud& cloud, const std::string& up = "");

}  // namespace ps
