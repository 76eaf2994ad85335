// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: ours and other ways to make a cloud of frames.
#pragma once

#include <string>
#include <vector>

#include "libps/geometry/point.h"
#include "libps/geometry/view.h"

namespace ps::stress {

/// Ways to fuse: kOurs studies the frames first (frame_study.h), kOursUnguarded does not and lifts
/// flying pixels too; kAllPoints lifts everything and kVoxelGrid thins that with pcl::VoxelGrid.
inline const std::string kOurs = "ours", kOursUnguarded = "ours, no guard",
                         kAllPoints = "all points", kVoxelGrid = "voxel grid";

/// @brief Fuses frames; empty frames are passed over.
/// Throws ps::Error for other methods and as fuse() does.
Cloud fuse_by(const std::string& method, const std::vector<View>& frames);

/// @brief The mean of the points in each cell of a grid (pcl::VoxelGrid); the footprint is the
/// grid's.
/// @param leaf  metres; widened to a thousandth of the cloud's extent
Cloud voxel_grid(const Cloud& cloud, float leaf);

}  // namespace ps::stress
