// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "libps/geometry/camera.h"
#include "libps/geometry/point.h"

namespace ps::apps {

/// What a point's colour in the viewer tells.
enum class ColorBy { photo, depth, view, origin };

/// The names of ColorBy, in its order.
const std::vector<std::string>& color_names();

using Rgb = std::array<std::uint8_t, 3>;

/// @brief One colour for each point. `depth`: near red, far blue, by distance from `from`; `view`:
/// a colour for each view; `origin`: observed points keep their photo's colour, outpainted ones are
/// orange.
std::vector<Rgb> point_colors(const Cloud& cloud, ColorBy by, const Pose& from);

/// @return the median distance of the points from `from`, metres; 1 for an empty cloud
double median_distance(const Cloud& cloud, const Pose& from);

}  // namespace ps::apps
