// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "libps/geometry/point.h"

namespace ps {

/// @brief Reads PLY or PCD, by extension; points that are not finite are dropped. Throws ps::Error
/// when it is neither, and as they do.
/// @param dropped  when given, told how many points were not finite
Cloud read_cloud(const std::filesystem::path& path, std::size_t* dropped = nullptr);

/// @brief Writes PLY or PCD, by extension. The file appears whole or not at all.
/// @param up          the world's axis that points up, which the header notes; empty = not known
/// @param compressed  of PCD: binary_compressed; a PLY is never compressed
void write_cloud(const std::filesystem::path& path, const Cloud& cloud, const std::string& up = "",
                 bool compressed = false);

/// @brief What the header of a cloud file says to readers: program, units, axes and scalars.
/// Internal, for the writers.
/// @param up      as above
/// @param begin   what each line begins with: `comment ` in PLY, `# ` in PCD
/// @param scalar  what our scalars' names begin with: `scalar_` in PLY, nothing in PCD
std::string cloud_comments(const std::string& up, const std::string& begin,
                           const std::string& scalar);

}  // namespace ps
