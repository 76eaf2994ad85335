// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/core/image.h"

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace ps {

struct Point;

/// @return whether there are points, and none has a colour: its red, green and blue are within two
/// of 255 levels. A scene of a grey photo is to stay grey, whatever networks paint.
bool is_grey(const pcl::PointCloud<Point>& cloud);

/// @return every pixel's luma (ITU-R BT.601) in all three channels
Image grey_of(const Image& image);

}  // namespace ps
