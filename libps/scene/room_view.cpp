// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/room_view.h"

#include <cstring>

namespace ps {

Intrinsics lens_of(const rooms::Camera& c) { return {c.width, c.height, c.fx, c.fy, c.cx, c.cy}; }

Pose pose_of(const rooms::Camera& camera) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 12; ++i) {
    matrix(i / 4, i % 4) = camera.world_from_cam[static_cast<std::size_t>(i)];
  }
  return checked_pose(matrix, "room camera");
}

View view_of(const rooms::Shot& shot, const rooms::Camera& camera) {
  View view;
  view.color.create(shot.height, shot.width);
  view.depth.create(shot.height, shot.width);
  std::memcpy(view.color.data, shot.color.data(), shot.color.size() * sizeof(float));
  std::memcpy(view.depth.data, shot.depth.data(), shot.depth.size() * sizeof(float));
  view.intrinsics = lens_of(camera);
  view.world_from_cam = pose_of(camera);
  return view;
}

}  // namespace ps
