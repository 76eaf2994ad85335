// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: the materials of a Wavefront OBJ, and their pictures.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

#include "libps/core/image.h"
#include "libps/rooms/model.h"

namespace ps {

/// What an MTL file says of a material, as far as a rooms::ModelMaterial holds it.
struct MtlMaterial {
  std::array<float, 3> color = rooms::ModelMaterial{}.color;  ///< Kd
  float opacity = 1;                                          ///< d, or 1 - Tr
  std::string texture;                                        ///< map_Kd, a file; may be empty
};

/// @brief Reads an MTL file; what a room's model does not hold is passed over. Throws ps::Error
/// when a number is none.
/// @param materials  gets what the file defines, by name
void parse_mtl(std::string_view text, const std::string& name,
               std::map<std::string, MtlMaterial>& materials);

/// A picture, and where it can be seen through.
struct CutTexture {
  rooms::Texture texture;
  Mask opaque;  ///< of the texture's size; empty = everywhere
};

/// @brief Decodes a picture and shrinks it, keeping its aspect, to `most_side` pixels a side at
/// most. Throws ps::Error when it is no image that io reads.
CutTexture parse_texture(std::string_view bytes, const std::string& name, int most_side);

}  // namespace ps
