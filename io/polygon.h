// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: a polygon's triangles.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace ps {

/// @brief Cuts a polygon, which may be concave, into triangles of its corners (ear clipping); one
/// of more than 256 corners, or that crosses itself, is cut as though it were convex.
/// @param corners  in order, roughly in one plane; three at least
/// @param triangles  becomes corners.size() - 2 triangles that turn as the polygon does
void triangulate(const std::vector<std::array<float, 3>>& corners,
                 std::vector<std::array<std::size_t, 3>>& triangles);

}  // namespace ps
