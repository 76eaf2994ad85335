// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/geometry/splat.h"

namespace ps {

/// @brief Splats a cloud so that its gaps close: what no point hits at one radius is taken from the
/// picture of twice that radius, up to `widest`. Where the cloud is dense it is as sharp as narrow
/// splats, where it is sparse as whole as wide ones.
///
/// A pyramid as of Grossman and Dally, "Point sample rendering" (1998), with the splats of
/// options in place of halved images. `missing` is what even the widest does not hit; `count` and
/// `nearest` are those of the first radius.
/// @param options  of the first, narrowest splat; see Splat for what comes back
/// @param widest   pixels, up to 64
/// Throws ps::Error as splat() does.
Splat closed_splat(const PointsView& points, const Intrinsics& intrinsics,
                   const Pose& world_from_cam, const SplatOptions& options, float widest);

template <typename PointT>
Splat closed_splat(const pcl::PointCloud<PointT>& cloud, const Intrinsics& intrinsics,
                   const Pose& world_from_cam, const SplatOptions& options, float widest) {
  return closed_splat(points_view(cloud), intrinsics, world_from_cam, options, widest);
}

}  // namespace ps
