// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/pose_pairs.h"

#include <algorithm>
#include <cmath>

#include "libps/core/random.h"
#include "libps/rooms/shot.h"

namespace ps {

Depth guessed_depth(const Depth& depth, double deviation, std::uint64_t seed) {
  constexpr std::uint32_t kWaves = 6;
  Depth guess = depth.clone();
  for (std::uint32_t wave = 0; wave < kWaves; ++wave) {
    const double along = 2 * M_PI * random_unit(seed, {wave, 0, 0, 0});
    const double phase = 2 * M_PI * random_unit(seed, {wave, 1, 0, 0});
    const double periods = 0.5 + 2 * random_unit(seed, {wave, 2, 0, 0});
    const double k = 2 * M_PI * periods / std::max(depth.cols, depth.rows);
    const double height = deviation * std::sqrt(2.0 / kWaves);
    for (int y = 0; y < depth.rows; ++y) {
      for (int x = 0; x < depth.cols; ++x) {
        const double at = k * (x * std::cos(along) + y * std::sin(along)) + phase;
        guess(y, x) *= static_cast<float>(std::exp(height * std::cos(at)));
      }
    }
  }
  return guess;
}

View room_view(const rooms::Room& room, const rooms::Camera& camera) {
  const rooms::Shot shot = rooms::shoot(room, camera);
  View view;
  view.intrinsics = {camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy};
  view.color = Image(shot.height, shot.width);
  view.depth = Depth(shot.height, shot.width);
  std::copy(shot.color.begin(), shot.color.end(), view.color.ptr<float>());
  std::copy(shot.depth.begin(), shot.depth.end(), view.depth.ptr<float>());
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) view.world_from_cam(i, j) = camera.world_from_cam[4 * i + j];
  }
  view.world_from_cam = checked_pose(view.world_from_cam.matrix(), "room camera");
  return view;
}

PoseError pose_error(const Pose& found, const Pose& truth) {
  const Eigen::AngleAxisd turn(truth.linear().transpose() * found.linear());
  return {turn.angle() * 180 / M_PI, (found.translation() - truth.translation()).norm()};
}

}  // namespace ps
