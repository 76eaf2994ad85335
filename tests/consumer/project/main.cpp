// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "io/cloud_file.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/splat.h"
#include "libps/scene/camera_path.h"

int main(int, char** argv) {
  ps::View view;
  view.intrinsics = ps::intrinsics_from_fov(64, 48, 60);
  view.color = ps::Image(48, 64, cv::Vec3f(0.2f, 0.4f, 0.6f));
  view.depth = ps::Depth(48, 64, 2.0f);
  const ps::Cloud cloud = ps::lift(view);
  ps::write_cloud(argv[1], cloud);
  const ps::Pose left = ps::camera_path("left", view.world_from_cam).back();
  const ps::Splat seen = ps::splat(ps::read_cloud(argv[1]), view.intrinsics, left);
  const int hits = cv::countNonZero(seen.hit);
  std::cout << cloud.size() << " points, " << hits << " pixels hit\n";
  return cloud.size() == 64 * 48 && hits > 0 ? 0 : 1;
}
