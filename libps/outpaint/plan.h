// SPDX-License-Identifier: BSD-3-Clause
// Internal to the outpaint room: which cells have to be computed, and which of them at once.
#pragma once

#include <vector>

#include "libps/outpaint/order.h"

namespace ps::outpaint {

/// @brief Cells that do not look at each other, so that all are computed together.
struct Group {
  std::vector<int> cells;   ///< missing ones first
  std::size_t missing = 0;  ///< how many of them are sampled
  std::size_t first = 0;    ///< place of the first; the others follow
  std::vector<int> near,
      far;  ///< [cells][9]: what a tap looks at, with dilation 1 and 2; -1 = nothing
};

/// @brief A cell is shared when all that it looks at, and what that looks at, is known: its
/// activations are the same in every completion. The others come in levels, each looking only at
/// cells of earlier levels. Cells that no missing cell looks at, directly or through others, are
/// left out. A level's places are taken again by later ones once nothing looks at it any more.
struct Plan {
  Group shared;
  std::vector<Group> levels;
  std::vector<int> place;  ///< by cell: among the shared cells, or in a lane; -1 = left out
  std::vector<std::uint8_t> is_shared;  ///< by cell
  std::size_t lane_places = 0;          ///< that cells which are not shared take

  explicit Plan(const Order& order);
};

}  // namespace ps::outpaint
