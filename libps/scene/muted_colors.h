// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/core/image.h"

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace ps {

struct Point;

/// @brief How strong colours may be that networks paint beside a cloud, so that surroundings of a
/// grey photo stay grey, and those of a faded one faded.
///
/// A colour's strength is the greatest less the least of its channels. The limit is the strength
/// that one point in a thousand exceeds (of points evenly spread over the cloud, if there are
/// many); 0 where that is within two of 255 levels; above .1 it rises eleven times as fast, so that
/// ordinary photos set none.
/// @return from 0 to 1; 1 for an empty cloud
float color_limit(const pcl::PointCloud<Point>& cloud);

/// @return the image, stronger colours moved towards their luma (ITU-R BT.601) until they are
/// within the limit
Image muted(const Image& image, float limit);

}  // namespace ps
