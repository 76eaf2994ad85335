// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace ps::outpaint {

/// @brief The nearest pixel that is not missing, of every pixel (itself, if it is not missing), by
/// the distance transform of Borgefors, Distance transformations in digital images, 1986.
/// @param missing  not 0 = missing
/// @return [h, w] of row * width + column; empty where everything is missing
cv::Mat1i nearest_seen(const cv::Mat1b& missing);

}  // namespace ps::outpaint
