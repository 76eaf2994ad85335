// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "libps/geometry/point.h"
#include "libps/geometry/view.h"

namespace ps::bench {

/// @brief A view into a textured room, 6 m x 3 m x 6 m, with three boxes on its floor: exact depth
/// by casting a ray through each pixel's centre. The same bytes on every call.
/// @param world_from_cam  a pose inside the room; the origin is, looking along z
View room_view(const Intrinsics& intrinsics, const Pose& world_from_cam);

/// @brief Square pixels, 70 degrees across, principal point in the middle.
Intrinsics room_camera(int size);

/// @brief Where the benchmarks look from: between and behind the two views of room_cloud().
Pose room_target();

/// @brief Two square views of the room, lifted: like two photos with depth.
/// @param points  how many points; rounded to twice a square
Cloud room_cloud(std::size_t points);

}  // namespace ps::bench
