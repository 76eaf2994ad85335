// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/core/image.h"
#include "libps/geometry/view.h"

namespace ps {

struct FreeSpaceOptions {
  /// A point is before a surface when it is nearer by more than `tolerance_relative` of the
  /// surface's depth plus `tolerance_footprints` of the observing view's footprints there.
  double tolerance_relative = 0.01;
  double tolerance_footprints = 2;
};

/// @brief Which pixels, once lifted, would stand where an observed view looked through: in front
/// of the surface that it saw. They must not be added to the scene (PixelSynth section 3.2 adds
/// only what was missing; this holds new depths to what was seen).
/// @param view      its depth, camera and pose count; metres
/// @param pixels    asks where it is not 0; of the view's size
/// @param observed  as `view`; may be empty. A surface's depth is the least known one of the 3x3
/// pixels around where a point falls, so that a depth edge a pixel off condemns nothing; where none
/// is known, or beside the image, or behind the camera, a view says nothing.
/// @return 1 where at least one view contradicts; 0 where the view's own depth is unknown (0, NaN,
/// infinite, negative)
/// Throws ps::Error when sizes differ, a camera or pose is unsound, or a tolerance is negative.
Mask in_free_space(const View& view, const Mask& pixels, const std::vector<View>& observed,
                   const FreeSpaceOptions& options = {});

}  // namespace ps
