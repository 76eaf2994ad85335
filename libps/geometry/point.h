// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/register_point_struct.h>

#include <Eigen/Core>
#include <cstdint>
#include <pcl/impl/point_types.hpp>

namespace ps {

/// Whether a camera saw a point, or the outpainter made it up.
enum class Origin : std::uint8_t { observed = 0, outpainted = 1 };

/// @brief The one point type of the toolkit (DESIGN.md, "Words and conventions").
///
/// World frame, metres. `footprint` is the metres one pixel covered where the point was seen,
/// `view` the number of the view that added it, `origin` an ps::Origin.
struct EIGEN_ALIGN16 Point {
  PCL_ADD_POINT4D;
  PCL_ADD_RGB;
  float footprint = 0;
  std::uint16_t view = 0;
  std::uint8_t origin = 0;

  Point() {
    x = y = z = 0;
    data[3] = 1;
    rgba = 0xff000000u;
  }
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

using Cloud = pcl::PointCloud<Point>;

}  // namespace ps

POINT_CLOUD_REGISTER_POINT_STRUCT(ps::Point,
                                  (float, x, x)(float, y, y)(float, z, z)(std::uint32_t, rgba,
                                                                          rgba)(float, footprint,
                                                                                footprint)(
                                      std::uint16_t, view, view)(std::uint8_t, origin, origin))
