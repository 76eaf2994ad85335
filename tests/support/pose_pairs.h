// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "libps/geometry/view.h"
#include "libps/rooms/camera.h"

namespace ps {

/// @brief A depth that is wrong as a network's guess is: smoothly, by the exponential of a sum of
/// waves of about one to three periods in the image, normal with this standard deviation.
Depth guessed_depth(const Depth& depth, double deviation, std::uint64_t seed);

/// @return what a camera sees of a procedural room
View room_view(const rooms::Room& room, const rooms::Camera& camera);

/// How far one pose is from the true one.
struct PoseError {
  double degrees = 0;
  double metres = 0;
};
PoseError pose_error(const Pose& found, const Pose& truth);

}  // namespace ps
