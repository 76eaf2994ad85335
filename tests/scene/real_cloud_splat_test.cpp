// SPDX-License-Identifier: BSD-3-Clause
// The splatter against its KD-tree reference on clouds of RGB-D frames, seen from a third one.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/rgbd_folder.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/splat.h"
#include "libps/geometry/splat_bins.h"
#include "tests/geometry/splat_reference.h"

namespace ps {
namespace {

PlanePoints plane_points(const Cloud& cloud, const Intrinsics& intrinsics, const Pose& pose) {
  const SplatOptions defaults;
  const PlaneArrays plane = project_points(points_view(cloud), intrinsics, pose, defaults);
  PlanePoints points = {plane.u, plane.v, plane.z, {}};
  for (const Point& p : cloud) points.color.emplace_back(p.r / 255.f, p.g / 255.f, p.b / 255.f);
  return points;
}

void expect_splat_as_reference(const std::filesystem::path& path) {
  const RgbdFolder folder = open_rgbd_folder(path);
  ASSERT_GE(folder.frames.size(), 9u);
  Cloud cloud;
  for (const std::size_t i : {0, 8}) {
    const View view = load_frame(folder, folder.frames[i]);
    LiftOptions options;
    cloud += lift(view, liftable(view.depth, view.intrinsics, options), 0, Origin::observed);
  }
  const Intrinsics small =
      resized(folder.intrinsics, folder.intrinsics.width / 3, folder.intrinsics.height / 3);
  const Pose& pose = folder.frames[4].world_from_cam;
  const SplatOptions options;
  const Splat fast = splat(points_view(cloud), small, pose, options);
  const cv::Size size(small.width, small.height);
  const Splat expected = splat_reference(plane_points(cloud, small, pose), size, options);
  EXPECT_GT(cv::countNonZero(expected.hit), size.area() / 2);
  EXPECT_LE(cv::norm(fast.color, expected.color, cv::NORM_INF), 1.0 / 510);
  EXPECT_EQ(cv::norm(fast.hit, expected.hit, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(fast.missing, expected.missing, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(fast.first_depth, expected.first_depth, cv::NORM_INF), 0);
}

TEST(RealCloudSplat, room_agrees_with_the_kd_tree_reference) {
  expect_splat_as_reference(PS_DATA_DIR "/room");
}

TEST(RealCloudSplat, walk_agrees_with_the_kd_tree_reference) {
  const std::filesystem::path walk = PS_SHARED_DIR "/rgbd/walk";
  if (!std::filesystem::exists(walk)) GTEST_SKIP() << walk << " is not here";
  expect_splat_as_reference(walk);
}

}  // namespace
}  // namespace ps
