// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "libps/geometry/camera.h"

namespace ps {

/// @brief Reads pinhole intrinsics; the kind is told from the content:
/// Open3D pinhole JSON (column-major 3x3), COLMAP cameras.txt (SIMPLE_PINHOLE, PINHOLE, and radial
/// models whose distortion is 0; its half pixel is taken off), or 3x3 numbers as text.
/// @param width,height  the photo's size: fills in what a 3x3 text does not say, and scales
/// intrinsics of another size; 0 = take the file's own
/// Throws ps::Error on anything else: distortion, differing aspect, several cameras, bad numbers.
Intrinsics read_intrinsics(const std::filesystem::path& path, int width = 0, int height = 0);

/// @brief The same from a file's bytes; `name` stands in messages.
Intrinsics parse_intrinsics(std::string_view bytes, const std::string& name, int width = 0,
                            int height = 0);

/// @brief Writes Open3D JSON (`.json`), COLMAP (`.txt` named cameras.txt), else 3x3 text.
/// The file appears whole or not at all. Throws ps::Error when the intrinsics are unsound.
void write_intrinsics(const std::filesystem::path& path, const Intrinsics& intrinsics);

}  // namespace ps
