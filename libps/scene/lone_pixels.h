// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/core/image.h"

namespace ps {

/// @brief Depths that hardly any neighbour shares, as glass, mirrors and stray light make them: a
/// pixel is alone when, of the known pixels in the 5x5 around it, fewer than two and fewer than
/// 15 % agree with it. Lines one pixel wide are not alone, nor is a pixel with two known neighbours
/// or fewer, of which too little can be said.
/// @param depth      metres; 0 = unknown
/// @param tolerance  share of the depth, to agree
/// @return 1 where a known depth is alone; empty of an empty depth
Mask lone_pixels(const Depth& depth, double tolerance = .05);

}  // namespace ps
