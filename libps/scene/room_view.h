// SPDX-License-Identifier: BSD-3-Clause
// Procedural rooms (libps/rooms) in this library's words.
#pragma once

#include "libps/geometry/view.h"
#include "libps/rooms/shot.h"

namespace ps {

Intrinsics lens_of(const rooms::Camera& camera);

/// @brief Throws ps::Error as checked_pose() does.
Pose pose_of(const rooms::Camera& camera);

/// @param shot  by this camera
View view_of(const rooms::Shot& shot, const rooms::Camera& camera);

}  // namespace ps
