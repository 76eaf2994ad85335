// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "libps/rooms/camera.h"
#include "libps/rooms/room.h"

namespace ps::rooms {

/// @brief What a camera sees.
struct Shot {
  int width = 0, height = 0;
  std::vector<float> color;  ///< height*width*3, sRGB in [0,1]
  std::vector<float> depth;  ///< height*width, metres along z at pixel centres; 0 = outside
};

/// @brief Draws what `camera` sees: depth by one exact ray for each pixel, colour with soft
/// shadows, bounce light and smoothed edges. The exposure is the room's, so that two shots of it
/// agree. The same bytes whatever the thread; runs on the calling thread alone.
/// Throws ps::Error for a size or focal length that is not positive.
Shot shoot(const Room& room, const Camera& camera);

/// @brief Depth alone, the same as that of shoot().
std::vector<float> shoot_depth(const Room& room, const Camera& camera);

/// @brief True visibility, by a ray for each pixel.
/// @param depth_b  what shoot() or shoot_depth() gives for camera `b`
/// @return for each pixel of `b`, 1 if its surface point lies in the picture of `a` and nothing
/// stands before it, else 0
std::vector<std::uint8_t> seen_from(const Room& room, const Camera& a, const Camera& b,
                                    const std::vector<float>& depth_b);

}  // namespace ps::rooms
