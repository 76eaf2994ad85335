// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: the points of a cloud that planned views see, ready to be thinned.
#pragma once

#include <cstdint>
#include <vector>

#include "libps/geometry/point.h"
#include "libps/scene/budget.h"

namespace ps {

/// One point, or one that speaks for several.
struct Sample {
  Eigen::Vector3f position;  ///< world, metres
  Eigen::Vector3f color;     ///< mean r, g, b, 0 to 255
  float pixel;               ///< metres that a pixel covers there, where it covers least
  float weight;              ///< how many points it speaks for
  float area;                ///< square metres: the sum of the squares of their footprints
  float footprint;           ///< metres, the greatest of theirs
  float spread;              ///< metres to the farthest of them
  std::uint32_t point;       ///< its number in the cloud
  std::uint8_t origin;
};

/// @brief Finds for each finite point the planned view that shows it finest, in whose image, grown
/// by `margin` pixels, it falls. Nothing hides anything.
/// @param unseen  receives the numbers of finite points that fall in no view, in order
/// @return the others; near each other in memory where they are in space
std::vector<Sample> seen_samples(const Cloud& cloud, const std::vector<PlannedView>& views,
                                 double margin, std::vector<std::uint32_t>* unseen);

}  // namespace ps
