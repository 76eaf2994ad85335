// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: the same places in two photos.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "libps/core/image.h"

namespace ps {

/// A place in two photos, pixels.
struct PixelMatch {
  Eigen::Vector2d first;
  Eigen::Vector2d second;
};

/// @return how many pixels of a photo a pixel of the picture spans that features are found in; at
/// least 1
double pixels_per_feature_pixel(cv::Size photo);

/// @brief Matches SIFT features (Lowe, IJCV 2004; OpenCV's) that are each other's nearest and are
/// clearly nearer than the next (his ratio test). A pair of places is given once.
/// The order is that of the first photo's features: the same bytes for any number of threads.
/// Photos in which nothing stands out, or narrower than 16 pixels, have no matches.
std::vector<PixelMatch> match_photos(const Image& first, const Image& second);

}  // namespace ps
