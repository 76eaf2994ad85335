// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace ps {

/// RGB in this channel order, float in [0,1], row-major; pixel centres are at integers.
using Image = cv::Mat3f;

/// Metres along the camera's z axis; 0 = unknown.
using Depth = cv::Mat1f;

/// 0 or 1 for each pixel.
using Mask = cv::Mat1b;

}  // namespace ps
