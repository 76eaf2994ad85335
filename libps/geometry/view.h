// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/core/image.h"
#include "libps/geometry/camera.h"

namespace ps {

/// @brief One photo with its depth, camera and pose: what a scene is made of.
/// `color`, `depth` and `intrinsics` are of one size.
struct View {
  Image color;
  Depth depth;
  Intrinsics intrinsics;
  Pose world_from_cam = Pose::Identity();
};

/// @brief Throws ps::Error, naming `where`, unless the sizes agree, the camera is sound and at
/// least one depth is positive and finite.
void check(const View& view, const std::string& where);

}  // namespace ps
