// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "libps/geometry/point.h"

namespace ps {

/// @brief Reads a cloud from PLY: ASCII, binary little or big endian; float or double; colours
/// named red/r/diffuse_red (uchar, ushort or float in [0,1]); our scalar_footprint, scalar_view and
/// scalar_origin when there; other properties, faces and other elements are ignored.
/// Points that are not finite are dropped; points without colour are grey (128).
/// @param dropped  when given, told how many points were not finite
/// Throws ps::Error when the header is not a PLY's, promises more than the file holds, or lacks x y
/// z.
Cloud read_ply(const std::filesystem::path& path, std::size_t* dropped = nullptr);

/// @brief The same from a file's bytes; `name` stands in messages.
Cloud parse_ply(std::string_view bytes, const std::string& name, std::size_t* dropped = nullptr);

/// @brief Writes binary little-endian PLY: x y z, red green blue, scalar_footprint, scalar_view,
/// scalar_origin; comments give tool, version, units and axes (DESIGN.md, "Files").
/// @param up  the world's axis that points up, for the comment: "y", "-z", ...; empty = not known
/// The file appears whole or not at all. Throws ps::Error when a coordinate is not finite.
void write_ply(const std::filesystem::path& path, const Cloud& cloud, const std::string& up = "");

}  // namespace ps
