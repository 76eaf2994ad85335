// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "libps/geometry/depth_alignment.h"

namespace ps {

/// What align_depth() is given, and the truth.
struct AlignmentCase {
  Depth truth, estimate, cloud;
  Mask visible, missing;
};

/// How an estimate is wrong.
struct Distortion {
  double scale = 1;
  double exponent = 1;
  double smooth = 0;  ///< about the greatest error that changes slowly over the image, of log depth
  double noise = 0;   ///< standard deviation of the log depth of each pixel
};

Depth distorted(const Depth& truth, const Distortion& distortion, std::uint32_t seed);

/// @return a case whose cloud is the truth within `seen`; the rest is missing
AlignmentCase hidden(const Depth& truth, cv::Rect seen);

/// A wide view of the box world, of which the middle is seen; `number` picks the view.
AlignmentCase box_world_case(int number);

/// A camera in a furnished room, and what a second one, turned and moved, sees of the first one's
/// picture.
AlignmentCase furnished_case(std::uint32_t seed);

/// @return the mean relative error where the case is missing and the truth known
double abs_rel(const Depth& depth, const AlignmentCase& c);

/// @return the estimate by the scale and exponent that were found, alone
Depth fitted(const AlignmentCase& c, const AlignedDepth& aligned);

/// @return the estimate, times the median ratio over visible pixels
Depth median_scaled(const AlignmentCase& c);

}  // namespace ps
