// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/geometry/splat.h"

namespace ps {

constexpr float kFinestSplat = 1;  ///< pixels; of splats that show a cloud as sharp as it is

/// @brief Splats a cloud with splats as wide as what each point stands for, and closes the gaps
/// that are left. Where the cloud is dense it is as sharp as narrow splats, which keep slanted
/// surfaces in their place; where it is sparse, as whole as wide ones; and surfaces do not grow
/// beyond their outlines.
///
/// Radii follow the footprints (SplatOptions::finest), and what is a twentieth farther than the
/// first hit of a pixel is hidden. A gap is where a closing of inverse depth by squares, each twice
/// as wide, is nearer than what is shown: the surface around it is nearer than what is seen through
/// it, or nothing is seen. It takes the mean of that surface's pixels beside it, ring by ring. What
/// is cut by the picture's edge may reach on to it. After Grossman and Dally, "Point sample
/// rendering" (1998), which closes gaps by a pyramid.
/// @param options  `finest` is not looked at; radius is that of the widest splats, and how wide
/// gaps are that are closed; see Splat for what comes back. `missing` is of what no gap was closed
/// over; `count` and `nearest` are of the splats
/// @param finest   pixels; of the narrowest. From options.radius on, this is splat()
/// Throws ps::Error as splat() does, also of `finest`.
Splat closed_splat(const PointsView& points, const Intrinsics& intrinsics,
                   const Pose& world_from_cam, const SplatOptions& options,
                   float finest = kFinestSplat);

template <typename PointT>
Splat closed_splat(const pcl::PointCloud<PointT>& cloud, const Intrinsics& intrinsics,
                   const Pose& world_from_cam, const SplatOptions& options,
                   float finest = kFinestSplat) {
  return closed_splat(points_view(cloud), intrinsics, world_from_cam, options, finest);
}

}  // namespace ps
