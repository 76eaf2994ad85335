// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "libps/geometry/point.h"
#include "libps/geometry/view.h"

namespace ps {

struct LiftOptions {
  double min_depth = 0.0;  ///< metres; nearer pixels are skipped
  double max_depth = 1e4;  ///< metres; farther pixels are skipped
  /// A pixel is a flying pixel when it hangs between two opposite neighbours, more than this many
  /// footprints behind one and before the other. 0 keeps them all. 8 is a surface seen at 83
  /// degrees. Where the image is so noisy that chance alone would give as much, it takes more.
  double edge_footprints = 8;
  /// Depth that a network guessed from the picture: as it knows nothing of the lens, its steps from
  /// one pixel to the next are no smaller for a long one. Of lenses longer than two short sides of
  /// the image, flying pixels are then told as through one of two.
  bool estimated = false;
};

/// @brief Which pixels of a depth image stand for a surface.
/// @param depth  metres, 0 = unknown; NaN, infinite and negative values count as unknown
/// @return 1 where the depth is known, in range and not a flying pixel
Mask liftable(const Depth& depth, const Intrinsics& intrinsics, const LiftOptions& options = {});

/// @brief Lifts pixels to coloured points in the world frame (SPEC.md 1; PixelSynth section 3.1).
/// @param pixels  lifts where this is not 0; of the view's size; chosen pixels must have a depth
/// @param view_number  written to each point's `view`
/// Points come in row-major order of their pixels. Throws ps::Error when sizes
/// differ or the pose is no rigid transform.
Cloud lift(const View& view, const Mask& pixels, std::uint16_t view_number, Origin origin);

/// @brief The same, for all liftable pixels.
Cloud lift(const View& view, std::uint16_t view_number = 0, Origin origin = Origin::observed,
           const LiftOptions& options = {});

}  // namespace ps
