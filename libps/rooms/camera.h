// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "libps/rooms/room.h"

namespace ps::rooms {

/// @brief A pinhole camera with its pose. Pixel centres are at integers; camera axes x right,
/// y down, z forward; metres.
struct Camera {
  int width = 256, height = 256;
  float fx = 256, fy = 256, cx = 127.5f, cy = 127.5f;  ///< pixels
  /// Row-major 3x4: point_in_world = R * point_in_cam + t.
  std::array<float, 12> world_from_cam = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

struct CameraOptions {
  int width = 256, height = 256;
  float min_fov = 35, max_fov = 95;            ///< degrees, horizontal
  float min_height = 0.3f, max_height = 2.2f;  ///< metres above the floor; mostly 1 to 1.7
  float max_pitch = 40;                        ///< degrees; mostly small
  float max_roll = 6;                          ///< degrees; mostly small
};

/// @brief A camera where somebody would take a photo: in free space, looking at something that is
/// neither at the nose nor all outside. Throws ps::Error for options that leave no camera.
Camera random_camera(const Room& room, std::uint64_t seed, const CameraOptions& options = {});

/// @brief A second camera near `camera`, in free space: turned by up to `max_rotation` radians
/// about a random axis (mostly the upright one) and moved by up to `max_translation` metres.
/// Where nothing is free, it only turns.
Camera moved(const Room& room, const Camera& camera, std::uint64_t seed, float max_rotation,
             float max_translation);

/// @return true if no surface is nearer to the camera than `clearance` metres and it is inside
/// of no thing
bool in_free_space(const Room& room, const Camera& camera, float clearance = 0.2f);

}  // namespace ps::rooms
