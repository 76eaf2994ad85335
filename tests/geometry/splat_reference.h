// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/geometry/splat.h"

namespace ps {

/// @brief SPEC.md 4 word by word, in double precision: a KD-tree of the points in the image plane,
/// a radius search for each pixel, hits sorted by (depth, index). Slow; for tests only. Fills every
/// field of Splat, whatever the options say.
Splat splat_reference(const PlanePoints& points, cv::Size size, const SplatOptions& options);

}  // namespace ps
