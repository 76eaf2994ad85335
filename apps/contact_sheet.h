// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "libps/core/image.h"

namespace ps::apps {

/// A picture on a contact sheet, and its place in the grid.
struct SheetTile {
  std::string name;
  Image image;
  int row = 0;
  int column = 0;
};

/// @brief Small copies of the pictures in a grid, each with its name above it.
/// @param tile_width  pixels; heights follow the first picture's aspect
Image contact_sheet(const std::vector<SheetTile>& tiles, int tile_width = 320);

}  // namespace ps::apps
