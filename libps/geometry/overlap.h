// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "libps/geometry/view.h"

namespace ps {

/// @brief Depth of a surface between pixel centres: bilinear in 1/z, which is exact on planes.
/// @param usable  1 where the depth is that of a surface (liftable()); of its size
/// @param u, v    pixels; at most half a pixel outside of the image counts as its border
/// @return metres; 0 where a pixel around (u, v) is not usable or they show more than one surface
double surface_depth(const Depth& depth, const Mask& usable, double u, double v);

/// One place that two views see.
struct DepthRatio {
  float u = 0;  ///< pixel in the second view
  float v = 0;
  float log_ratio = 0;  ///< log of the depth there by the first view / by the second
};

/// @brief Compares the depths of two views: pixels of the first are lifted and looked at from the
/// second's camera. A place that the second does not see, as something stands before it, has a
/// great ratio: take medians, and leave out what is far from them.
/// @param first, second  colours are not looked at and may be empty
/// @param most  about how many places to look at, evenly over the first view
/// @return in row-major order of the first view's pixels
std::vector<DepthRatio> depth_ratios(const View& first, const View& second,
                                     std::size_t most = 200000);

}  // namespace ps
