// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/camera.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "libps/core/error.h"

namespace ps {
namespace {

const Intrinsics kCamera{540, 360, 495.5, 495.4, 269.5, 169.2};

TEST(Camera, project_undoes_lift) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const double u = unit(random) * 540, v = unit(random) * 360, z = 0.1 + 50 * unit(random);
    const Eigen::Vector2d back = kCamera.project(kCamera.lift(u, v, z));
    EXPECT_NEAR(back.x(), u, 1e-9);
    EXPECT_NEAR(back.y(), v, 1e-9);
  }
}

TEST(Camera, resizing_keeps_rays_and_the_half_pixel) {
  const Intrinsics half = resized(kCamera, 270, 180);
  // The corner of the image (-0.5, -0.5) is the corner of the resized image.
  const Eigen::Vector3d corner = kCamera.lift(-0.5, -0.5, 1);
  EXPECT_NEAR(half.project(corner).x(), -0.5, 1e-12);
  EXPECT_NEAR(half.project(corner).y(), -0.5, 1e-12);
  const Eigen::Vector3d other = kCamera.lift(539.5, 359.5, 1);
  EXPECT_NEAR(half.project(other).x(), 269.5, 1e-12);
  EXPECT_NEAR(half.project(other).y(), 179.5, 1e-12);
}

TEST(Camera, field_of_view_spans_the_image) {
  const Intrinsics k = intrinsics_from_fov(640, 480, 90);
  EXPECT_NEAR(k.lift(-0.5, 0, 1).x(), -1, 1e-12);
  EXPECT_NEAR(k.lift(639.5, 0, 1).x(), 1, 1e-12);
  EXPECT_THROW(intrinsics_from_fov(640, 480, 180), Error);
  EXPECT_THROW(intrinsics_from_fov(640, 480, 0), Error);
  EXPECT_THROW(intrinsics_from_fov(640, 480, std::nan("")), Error);
}

TEST(Camera, a_35mm_lens_on_a_3_to_2_frame_is_itself) {
  EXPECT_NEAR(intrinsics_from_focal_35mm(3600, 2400, 50).fx, 5000, 1e-6);
}

TEST(Camera, unsound_intrinsics_are_refused_with_their_place) {
  Intrinsics bad = kCamera;
  bad.fx = -1;
  try {
    check(bad, "intrinsics.json");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("intrinsics.json"), std::string::npos);
  }
  bad = kCamera;
  bad.cy = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check(bad, "x"), Error);
  bad = kCamera;
  bad.width = 0;
  EXPECT_THROW(check(bad, "x"), Error);
}

TEST(Pose, non_rotations_are_refused_and_small_errors_mended) {
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose(0, 0) = 1 + 1e-4;
  const Pose mended = checked_pose(pose, "x");
  EXPECT_LT((mended.linear() * mended.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
            1e-12);
  pose(0, 0) = 1.1;
  EXPECT_THROW(checked_pose(pose, "x"), Error);
  pose(0, 0) = -1;  // a mirror
  EXPECT_THROW(checked_pose(pose, "x"), Error);
  pose(0, 0) = 1;
  pose(1, 3) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(checked_pose(pose, "x"), Error);
  pose(1, 3) = 0;
  pose(3, 0) = 0.1;
  EXPECT_THROW(checked_pose(pose, "x"), Error);
}

}  // namespace
}  // namespace ps
