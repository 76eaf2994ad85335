// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/room_view.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "libps/core/error.h"

namespace ps {
namespace {

using Rows = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

void check_sizes(const rooms::Shot& shot, const rooms::Camera& camera) {
  const std::size_t pixels = static_cast<std::size_t>(std::max(shot.width, 0)) *
                             static_cast<std::size_t>(std::max(shot.height, 0));
  const bool fits = pixels > 0 && shot.color.size() == 3 * pixels && shot.depth.size() == pixels &&
                    camera.width == shot.width && camera.height == shot.height;
  if (fits) return;
  throw Error("room view",
              "a shot of " + std::to_string(shot.width) + "x" + std::to_string(shot.height) +
                  " has " + std::to_string(shot.color.size()) + " colours and " +
                  std::to_string(shot.depth.size()) + " depths, its camera " +
                  std::to_string(camera.width) + "x" + std::to_string(camera.height),
              "all of one size");
}

}  // namespace

Intrinsics room_lens(const rooms::Camera& c) { return {c.width, c.height, c.fx, c.fy, c.cx, c.cy}; }

Pose room_pose(const rooms::Camera& camera) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topRows<3>() = Eigen::Map<const Rows>(camera.world_from_cam.data()).cast<double>();
  return checked_pose(matrix, "room camera");
}

rooms::Camera room_camera(const Intrinsics& lens, const Pose& world_from_cam) {
  rooms::Camera camera;
  camera.width = lens.width;
  camera.height = lens.height;
  camera.fx = static_cast<float>(lens.fx);
  camera.fy = static_cast<float>(lens.fy);
  camera.cx = static_cast<float>(lens.cx);
  camera.cy = static_cast<float>(lens.cy);
  Eigen::Map<Rows>(camera.world_from_cam.data()) =
      world_from_cam.matrix().topRows<3>().cast<float>();
  return camera;
}

View view_of(const rooms::Shot& shot, const rooms::Camera& camera) {
  check_sizes(shot, camera);
  const cv::Size size(shot.width, shot.height);
  View view;
  view.color.create(size);
  view.depth.create(size);
  std::memcpy(view.color.data, shot.color.data(), shot.color.size() * sizeof(float));
  std::memcpy(view.depth.data, shot.depth.data(), shot.depth.size() * sizeof(float));
  view.intrinsics = room_lens(camera);
  view.world_from_cam = room_pose(camera);
  return view;
}

View shoot_view(const rooms::Room& room, const rooms::Camera& camera) {
  return view_of(rooms::shoot(room, camera), camera);
}

}  // namespace ps
