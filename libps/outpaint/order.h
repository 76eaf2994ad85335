// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "libps/models/pixel_cnn.h"

namespace ps::outpaint {

/// @brief In which order the codes of a view are generated, and what each may look at (SPEC.md 6).
/// It grows outward from the middle of what is seen; ties go to the smaller row, then the smaller
/// column, as in the published code.
struct Order {
  int height = 0, width = 0;          ///< cells
  std::vector<int> distance;          ///< by cell: to the border of what is seen; most inside it
  std::vector<int> cells;             ///< cells (row * width + column) from first to last
  std::vector<int> rank;              ///< by cell: its place in `cells`
  std::vector<std::uint8_t> missing;  ///< by cell: 1 = its code is to be sampled
  models::LocalMasks masks;

  std::size_t size() const { return cells.size(); }
};

/// @brief The order for a view's background mask.
/// @param background  not 0 = nothing was projected here (dilated, SPEC.md 4); sides multiples of
/// `cell`
/// @param cell        side of a cell, pixels
/// Cells are missing where all of their pixels are background. Throws ps::Error when a side is no
/// multiple.
Order order_of(const cv::Mat1b& background, int cell = 8);

/// @brief An order that was made elsewhere; fills in ranks and masks.
/// @param cells    every cell of the grid once; else throws ps::Error
/// @param missing  one value for each cell
Order order_from(int height, int width, std::vector<int> cells, std::vector<std::uint8_t> missing);

}  // namespace ps::outpaint
