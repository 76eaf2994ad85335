// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/eval/perceptual.h"
#include "libps/geometry/view.h"

namespace ps {

/// What one camera would show of another one's image.
struct Warp {
  Image color;  ///< 0 where not valid
  Mask valid;   ///< 1 where the other image has all four pixels that the colour is made of
};

/// @brief Turns a camera about its centre: the homography K R K^-1, bilinear (Hartley and
/// Zisserman, Multiple View Geometry, section 8.4). Exact but for resampling, whatever the lenses,
/// as the centres are one.
/// @param source  its depth is not looked at and may be empty
/// @return of the target lens's size
/// Throws ps::Error when a camera is unsound, the image is not of its lens's size, or the centres
/// are more than 0.1 mm apart.
Warp warp_rotation(const View& source, const Intrinsics& target, const Pose& world_from_target);

/// @brief How well two views of one scene from one centre agree (SPEC.md 11): the mean of both
/// ways.
struct ConsistencyScore {
  double psnr = 0;        ///< dB on the overlap; infinite when one way is equal there
  double perceptual = 0;  ///< of the two images, black outside the overlap; NaN when not measured
  double overlap = 0;     ///< share of pixels
};

/// @brief Warps each image into the other's camera and compares; where there is no overlap, psnr
/// and perceptual are NaN. Which of the two comes first changes nothing.
/// @param a, b  colour, lens and pose; depth is not looked at. Sizes and lenses may differ.
/// @param perceptual  may be empty
/// Throws ps::Error as warp_rotation() and `perceptual` do.
ConsistencyScore consistency(const View& a, const View& b,
                             const PerceptualDistance& perceptual = {});

}  // namespace ps
