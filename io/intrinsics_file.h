// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "libps/geometry/camera.h"

namespace ps {

/// @brief Reads pinhole intrinsics; the kind is told from the content:
/// Open3D pinhole JSON (column-major 3x3), COLMAP cameras.txt (SIMPLE_PINHOLE, PINHOLE, and radial
/// models whose distortion is 0; its half pixel is taken off), or 3x3 numbers as text.
/// @param width,height  the photo's size: fills in what a 3x3 text does not say, and scales
/// intrinsics of another size; 0 = take the file's own
/// Throws ps::Error on anything else: distortion, differing aspect, several cameras, bad numbers.
Intrinsics read_intrinsics(const std::filesystem::path& path, int width = 0, int height = 0);

/// @brief Writes Open3D JSON (`.json`), COLMAP (`.txt` named cameras.txt), else 3x3 text.
void write_intrinsics(const std::filesystem::path& path, const Intrinsics& intrinsics);

}  // namespace ps
