// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/geometry/view.h"

namespace ps {

/// @brief A view of an exact little world for tests: a room of 6 x 3 x 8 metres around the origin
/// with three boxes in it, smooth colours that depend on the surface point alone. Camera axes: y is
/// down. Depth is exact to float, for every pixel whose ray is inside the room.
View box_world_view(const Intrinsics& intrinsics, const Pose& world_from_cam);

/// @return a pose at (x, y, z) metres that looks along z, turned by yaw to the right and pitch up
Pose pose_at(double x, double y, double z, double yaw, double pitch = 0);

/// @return poses of a walk of `count` steps through the world that never enters a box
std::vector<Pose> box_world_walk(int count);

}  // namespace ps
