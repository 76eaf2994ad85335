// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "libps/geometry/point.h"

namespace ps {

/// @brief Reads a cloud from PCD 0.7: ASCII, binary, binary_compressed; x y z, rgb or rgba, and our
/// footprint, view and origin when there. Points that are not finite are dropped.
/// @param dropped  when given, told how many points were not finite
/// Throws ps::Error when the header is unsound or promises more than the file holds.
Cloud read_pcd(const std::filesystem::path& path, std::size_t* dropped = nullptr);

/// @brief The same from a file's bytes; `name` stands in messages.
Cloud parse_pcd(std::string_view bytes, const std::string& name, std::size_t* dropped = nullptr);

/// @brief Writes PCD 0.7, binary or binary_compressed. The file appears whole or not at all.
/// Throws ps::Error when a coordinate is not finite, or a compressed block would not fit PCL's
/// 32-bit sizes (186 million points).
/// @param up  the world's axis that points up, which the header notes; empty = not known
void write_pcd(const std::filesystem::path& path, const Cloud& cloud, bool compressed = false,
               const std::string& up = "");

}  // namespace ps
