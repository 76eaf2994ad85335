// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: what the pixels of a shot see, until their colours are known.
#pragma once

#include <cstdint>
#include <vector>

#include "libps/rooms/material.h"
#include "libps/rooms/vec.h"

namespace ps::rooms {

struct Pixel {
  const Material* material = nullptr;  ///< null = outside
  Vec position, normal, flat;
  Vec albedo;
  float reflected = 0;  ///< share of what it shows; 0 = none
};

struct PicturePlane {
  PicturePlane(int w, int h);

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }

  int width, height;
  std::vector<Pixel> pixels;
  std::vector<float> depth;
  std::vector<Vec> light;   ///< irradiance / pi; outside: radiance
  std::vector<Vec> mirror;  ///< what surfaces reflect
  /// Number of surfaces' ends before a pixel, along its row and its column: two pixels of a row
  /// are of one smooth surface if theirs agree.
  std::vector<std::uint16_t> row_ends, column_ends;

  /// Fills row_ends and column_ends.
  void find_ends();
  /// Evens out the grain of the light: each sample of a 4x4 block is shared by its surface, then
  /// what is alike is shared more widely.
  void smooth_light();
  /// The same for reflections of rough surfaces.
  void smooth_mirror();
  /// @return pixels next to another surface or material
  std::vector<std::uint32_t> edges() const;
};

}  // namespace ps::rooms
