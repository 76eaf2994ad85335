// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "libps/nn/tensor.h"

namespace ps::outpaint {

/// @brief The nearest pixel that is not missing, of every pixel (itself, if it is not missing), by
/// the distance transform of Borgefors, Distance transformations in digital images, 1986.
/// @param missing  not 0 = missing
/// @return [h, w] of row * width + column; empty where everything is missing
cv::Mat1i nearest_seen(const cv::Mat1b& missing);

/// @param image    [1, h, w, 3]
/// @param missing  of its size; not 0 = missing
/// @return the image, with the nearest colours where it is missing; as it is where all of it is
nn::Tensor with_nearest_colors(const nn::TensorView& image, const cv::Mat1b& missing);

}  // namespace ps::outpaint
