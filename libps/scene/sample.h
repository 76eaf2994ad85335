// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: the points of a cloud that planned views see, ready to be thinned.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "libps/geometry/point.h"
#include "libps/scene/budget.h"
#include "libps/scene/meter.h"

namespace ps {

/// One point, or one that speaks for several.
struct Sample {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< world, metres
  Eigen::Vector3f color = Eigen::Vector3f::Zero();     ///< mean r, g, b, 0 to 255
  float pixel = 0;      ///< metres that a pixel covers there, where it covers least
  float weight = 1;     ///< how many points it speaks for
  float area = 0;       ///< square metres: about what their footprints cover together
  float footprint = 0;  ///< metres, the greatest of theirs
  float spread = 0;     ///< metres to the farthest of them
  float clear = std::numeric_limits<float>::infinity();  ///< metres, to where surfaces end or bend
  std::uint32_t point = 0;                               ///< its number in the cloud
  std::uint8_t origin = 0;
};

/// @brief Finds for each finite point the planned view that shows it finest, in whose image, grown
/// by `margin` pixels, it falls. Nothing hides anything.
/// @param unseen  receives the numbers of finite points that fall in no view, in order
/// @param meter   if given, told of two stages, to 0.3 of all
/// @return the others; near each other in memory where they are in space
std::vector<Sample> seen_samples(const Cloud& cloud, const std::vector<PlannedView>& views,
                                 double margin, std::vector<std::uint32_t>* unseen,
                                 Meter* meter = nullptr);

}  // namespace ps
