// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ps::rooms {

/// @brief A picture on a surface: RGB bytes, row-major, the first row on top (v = 1).
struct Texture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

struct ModelMaterial {
  std::array<float, 3> color = {0.7f, 0.7f, 0.7f};  ///< in [0,1], sRGB; times the texture
  float opacity = 1;
  int texture = -1;  ///< index into Model::textures, -1 = none
};

/// @brief A piece of furniture: triangles in metres, x right, y up, z towards whoever looks at its
/// front; its base stands on y = 0, centred on the origin in x and z.
struct Model {
  std::string name;             ///< as its catalogue calls it
  std::string category;         ///< "Bedroom", "Kitchen", ... as its catalogue says
  float elevation = 0;          ///< metres above the floor its base wants to be (lamps, shelves)
  bool door_or_window = false;  ///< belongs into a wall, not into a room
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 2>> uvs;  ///< empty, or one for each position
  struct Triangle {
    std::array<std::uint32_t, 3> corners;  ///< indices into positions and uvs
    std::uint32_t material = 0;
  };
  std::vector<Triangle> triangles;
  std::vector<ModelMaterial> materials;
  std::vector<Texture> textures;
};

}  // namespace ps::rooms
