// SPDX-License-Identifier: BSD-3-Clause
// Views of procedural rooms for tests.
#pragma once

#include "libps/geometry/view.h"
#include "libps/rooms/shot.h"

namespace ps {

/// Turns about its own axes: to the right, then up, radians.
inline rooms::Camera turned(const rooms::Camera& camera, double right, double up) {
  using Rows = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
  rooms::Camera other = camera;
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(right, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(up, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Eigen::Matrix3d rotation =
      Eigen::Map<const Rows>(camera.world_from_cam.data()).leftCols<3>().cast<double>();
  Eigen::Map<Rows>(other.world_from_cam.data()).leftCols<3>() = (rotation * turn).cast<float>();
  return other;
}

inline View room_view(const rooms::Room& room, const rooms::Camera& c) {
  using Rows = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
  rooms::Shot shot = rooms::shoot(room, c);
  View view;
  view.color =
      Image(shot.height, shot.width, reinterpret_cast<cv::Vec3f*>(shot.color.data())).clone();
  view.depth = Depth(shot.height, shot.width, shot.depth.data()).clone();
  view.intrinsics = {c.width, c.height, c.fx, c.fy, c.cx, c.cy};
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topRows<3>() = Eigen::Map<const Rows>(c.world_from_cam.data()).cast<double>();
  view.world_from_cam = checked_pose(matrix, "room camera");
  return view;
}

}  // namespace ps
