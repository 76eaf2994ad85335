// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "libps/geometry/view.h"
#include "libps/rooms/camera.h"
#include "libps/rooms/shot.h"

namespace ps {

constexpr std::uint64_t kRoomsOfSeed = 1000000;

/// @return what room i of a seed is made from: `train data --seed`, rooms:SEED:COUNT and `chart`
/// count alike. Seeds share no room where i is below kRoomsOfSeed.
constexpr std::uint64_t room_number(std::uint64_t seed, std::uint64_t i) {
  return seed * kRoomsOfSeed + i;
}

/// @return the lens of a camera in a procedural room
Intrinsics room_lens(const rooms::Camera& camera);

/// @return its pose; throws ps::Error when it is no rigid transform
Pose room_pose(const rooms::Camera& camera);

/// @return the same lens elsewhere
rooms::Camera room_camera(const Intrinsics& lens, const Pose& world_from_cam);

/// @param shot  by this camera
/// Throws ps::Error unless the shot's vectors and the camera's picture are of the shot's size, and
/// as room_pose() does.
View view_of(const rooms::Shot& shot, const rooms::Camera& camera);

/// @brief What a camera in a procedural room sees: exact depth, 0 outside of windows. Throws
/// ps::Error as rooms::shoot() and room_pose() do.
View shoot_view(const rooms::Room& room, const rooms::Camera& camera);

}  // namespace ps
