// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <cstdint>
#include <vector>

#include "libps/rooms/model.h"
#include "libps/rooms/vec.h"

namespace ps::rooms {

enum class Pattern : std::uint8_t {
  plain,
  plaster,       ///< faint unevenness
  wood,          ///< grain along u
  planks,        ///< a floor of wood: planks along u, `scale` wide
  herringbone,   ///< parquet in blocks that turn
  tiles,         ///< squares of `scale`, joints of the second colour
  bricks,        ///< `scale` long
  carpet,        ///< speckle
  carpet_tiles,  ///< squares of speckle, `scale` wide, two tones
  stripes,       ///< along v, `scale` apart
  checks,
  weave,  ///< cloth
  marble,
  speckle,  ///< terrazzo, linoleum
  blobs,    ///< wallpaper, prints
  text,     ///< lines of words, on a sheet with u, v in [0,1]
  grooves,  ///< dark lines across v, `scale` apart: slats, boards
  picture,  ///< `picture`, u and v in [0,1], repeated
};

/// What a surface looks like. Colours are linear.
struct Material {
  Pattern pattern = Pattern::plain;
  Vec color = {0.6f, 0.6f, 0.6f};
  Vec second = {0.3f, 0.3f, 0.3f};
  float scale = 0.3f;      ///< metres
  float amount = 1;        ///< how strong the pattern is
  float gloss = 0;         ///< reflected share, head on; 1 = mirror, which shows nothing else
  float roughness = 0.1f;  ///< spread of what is reflected
  Vec emission;            ///< radiance
  int picture = -1;
  std::uint32_t seed = 0;
};

/// A Texture and its halves, quarters, ...
class Picture {
 public:
  explicit Picture(const Texture& texture);
  /// @param footprint  how much of the picture's width a pixel covers
  /// @return linear colour, between the four nearest texels of a fitting level
  Vec at(float u, float v, float footprint) const;

 private:
  struct Level {
    int width, height;
    std::vector<std::uint8_t> rgb;
  };
  std::vector<Level> levels_;
};

/// @param footprint  metres (or shares of a picture) that a pixel covers: what is finer is faded
/// @return linear colour of the surface at (u, v)
Vec albedo(const Material& m, const std::vector<Picture>& pictures, float u, float v,
           float footprint);

/// In [0, 1), a function of the place.
inline float hash(int x, int y, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                    static_cast<std::uint32_t>(y) * 0xd8163841u ^ seed * 0xcb1ab31fu;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  h ^= h >> 15;
  return static_cast<float>(h >> 8) * 0x1p-24f;
}
/// Smooth noise in [0, 1], of period 1.
float noise(float x, float y, std::uint32_t seed);

}  // namespace ps::rooms
