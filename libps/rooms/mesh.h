// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libps/rooms/material.h"
#include "libps/rooms/vec.h"

namespace ps::rooms {

struct Corner {
  Vec position;
  Vec normal;          ///< of length 1; shading's
  float u = 0, v = 0;  ///< metres, or [0,1] over a picture
};

struct Face {
  std::array<std::uint32_t, 3> corners;
  std::uint32_t material = 0;
};

struct Mesh {
  std::vector<Corner> corners;
  std::vector<Face> faces;
};

}  // namespace ps::rooms
