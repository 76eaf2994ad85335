// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libps/core/error.h"
#include "libps/geometry/point.h"

namespace ps {
namespace {

const Pose kStart = [] {
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(1, 2, 3);
  return pose;
}();

/// Where the optical axis of `pose` points, in the camera frame of the start.
Eigen::Vector3d axis_in_start(const Pose& pose) {
  return (kStart.inverse() * pose).linear() * Eigen::Vector3d::UnitZ();
}

double angle_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

TEST(CameraPath, every_path_starts_at_the_start_and_has_as_many_frames_as_asked) {
  for (const std::string& name : path_names()) {
    for (const int frames : {1, 2, 3, 64}) {
      const std::vector<Pose> poses = camera_path(name, kStart, {frames});
      ASSERT_EQ(poses.size(), static_cast<std::size_t>(frames)) << name;
      EXPECT_EQ(poses.front().matrix(), kStart.matrix()) << name;
    }
  }
}

TEST(CameraPath, every_pose_is_a_rotation) {
  for (const std::string& name : path_names()) {
    for (const Pose& pose : camera_path(name, kStart, {64, 0.6, 0.3, 2})) {
      EXPECT_NO_THROW(checked_pose(pose.matrix(), name));
      EXPECT_NEAR((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
                  0, 1e-12);
    }
  }
}

struct Extreme {
  const char* name;
  double yaw;    // to the right
  double pitch;  // upwards
};

class Direction : public testing::TestWithParam<Extreme> {};

TEST_P(Direction, ends_looking_at_its_extreme) {
  const Extreme want = GetParam();
  const Eigen::Vector3d axis = axis_in_start(camera_path(want.name, kStart).back());
  EXPECT_NEAR(std::atan2(axis.x(), axis.z()), want.yaw, 1e-12);
  EXPECT_NEAR(std::asin(-axis.y()), want.pitch, 1e-12);  // y points down
}

TEST_P(Direction, turns_in_even_steps) {
  const std::vector<Pose> poses = camera_path(GetParam().name, kStart, {31});
  const double step = angle_between(poses[0], poses[1]);
  EXPECT_GT(step, 1e-3);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_NEAR(angle_between(poses[i - 1], poses[i]), step, 0.01 * step);
  }
}

INSTANTIATE_TEST_SUITE_P(spec_2, Direction,
                         testing::Values(Extreme{"left", -0.6, 0}, Extreme{"right", 0.6, 0},
                                         Extreme{"up", 0, 0.3}, Extreme{"down", 0, -0.3},
                                         Extreme{"up-left", -0.3, 0.15},
                                         Extreme{"up-right", 0.3, 0.15},
                                         Extreme{"down-left", -0.3, -0.15},
                                         Extreme{"down-right", 0.3, -0.15}),
                         [](const testing::TestParamInfo<Extreme>& extreme) {
                           std::string name = extreme.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(CameraPath, looking_left_moves_the_middle_of_the_photo_to_the_right) {
  const Intrinsics camera = intrinsics_from_fov(640, 480, 90);
  const Eigen::Vector3d middle = kStart * Eigen::Vector3d(0, 0, 2);
  const Pose left = camera_path("left", kStart).back();
  EXPECT_GT(camera.project(left.inverse() * middle).x(), camera.cx + 100);
  const Pose up = camera_path("up", kStart).back();
  EXPECT_GT(camera.project(up.inverse() * middle).y(), camera.cy + 50);
}

TEST(CameraPath, circle_and_sway_end_where_they_started) {
  for (const char* name : {"circle", "sway"}) {
    const std::vector<Pose> poses = camera_path(name, kStart, {33, 0.6, 0.3, 1});
    EXPECT_EQ(poses.back().matrix(), kStart.matrix()) << name;
    EXPECT_GT(angle_between(poses[8], kStart), 0.5) << name;
  }
}

TEST(CameraPath, circle_passes_left_down_right) {
  const std::vector<Pose> poses = camera_path("circle", kStart, {41});
  EXPECT_NEAR(axis_in_start(poses[10]).x(), -std::sin(0.6) * std::cos(0.15), 1e-9);
  EXPECT_NEAR(axis_in_start(poses[20]).y(), std::sin(0.3), 1e-9);
  EXPECT_NEAR(axis_in_start(poses[30]).x(), std::sin(0.6) * std::cos(0.15), 1e-9);
}

TEST(CameraPath, sway_reaches_both_extremes) {
  const std::vector<Pose> poses = camera_path("sway", kStart, {41});
  EXPECT_NEAR(axis_in_start(poses[10]).x(), -std::sin(0.6), 1e-9);
  EXPECT_NEAR(axis_in_start(poses[20]).x(), 0, 1e-9);
  EXPECT_NEAR(axis_in_start(poses[30]).x(), std::sin(0.6), 1e-9);
}

TEST(CameraPath, few_frames_of_a_closed_path_show_both_extremes) {
  for (const char* name : {"circle", "sway"}) {
    for (int frames = 3; frames < 20; ++frames) {
      double left = 0, right = 0;
      const std::vector<Pose> poses = camera_path(name, kStart, {frames, 0.6, 0});
      for (const Pose& pose : poses) {
        const Eigen::Vector3d axis = axis_in_start(pose);
        left = std::min(left, std::atan2(axis.x(), axis.z()));
        right = std::max(right, std::atan2(axis.x(), axis.z()));
      }
      EXPECT_NEAR(left, -0.6, 1e-9) << name << " " << frames;
      EXPECT_NEAR(right, 0.6, 1e-9) << name << " " << frames;
      EXPECT_EQ(poses.back().matrix() == kStart.matrix(), frames > 3) << name << " " << frames;
    }
    EXPECT_GT(angle_between(camera_path(name, kStart, {2}).back(), kStart), 0.5) << name;
  }
}

TEST(CameraPath, neighbouring_frames_of_a_closed_path_are_near) {
  for (const char* name : {"circle", "sway"}) {
    for (const int frames : {64, 65, 66, 67}) {
      const std::vector<Pose> poses = camera_path(name, kStart, {frames, 0.6, 0.3});
      const double most =
          1.1 * 2 * 3.1416 / (frames - 1) * 0.6;  // the sine's steepest, and a tenth
      for (std::size_t i = 1; i < poses.size(); ++i) {
        EXPECT_LT(angle_between(poses[i - 1], poses[i]), most) << name << " " << i;
      }
    }
  }
}

TEST(CameraPath, without_an_orbit_the_camera_turns_on_the_spot) {
  for (const Pose& pose : camera_path("circle", kStart)) {
    EXPECT_NEAR((pose.translation() - kStart.translation()).norm(), 0, 1e-12);
  }
}

TEST(CameraPath, an_orbit_keeps_its_pivot_in_the_middle_of_the_view) {
  const Eigen::Vector3d pivot = kStart * Eigen::Vector3d(0, 0, 2.5);
  for (const Pose& pose : camera_path("circle", kStart, {17, 1.2, 0.4, 2.5})) {
    EXPECT_NEAR((pose.inverse() * pivot - Eigen::Vector3d(0, 0, 2.5)).norm(), 0, 1e-12);
  }
  const Pose left = camera_path("left", kStart, {2, 0.6, 0.3, 2.5}).back();
  EXPECT_GT((left.translation() - kStart.translation()).norm(), 1);
}

TEST(CameraPath, an_unknown_name_lists_the_choices) {
  try {
    camera_path("spiral", kStart);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("spiral"), std::string::npos);
    for (const std::string& name : path_names()) {
      EXPECT_NE(message.find(name), std::string::npos) << name;
    }
  }
}

TEST(CameraPath, unsound_options_are_refused) {
  const double nan = std::nan("");
  EXPECT_THROW(camera_path("left", kStart, {0}), Error);
  EXPECT_THROW(camera_path("left", kStart, {5, -0.1}), Error);
  EXPECT_THROW(camera_path("left", kStart, {5, nan}), Error);
  EXPECT_THROW(camera_path("left", kStart, {5, 0.6, 4}), Error);
  EXPECT_THROW(camera_path("left", kStart, {5, 0.6, 0.3, -1}), Error);
  EXPECT_THROW(camera_path("left", kStart, {5, 0.6, 0.3, nan}), Error);
}

Cloud box_cloud(float half_x, float half_y, float half_z) {
  Cloud cloud;
  for (int i = 0; i < 8; ++i) {
    Point point;
    point.x = 10 + (i & 1 ? half_x : -half_x);
    point.y = 20 + (i & 2 ? half_y : -half_y);
    point.z = 30 + (i & 4 ? half_z : -half_z);
    cloud.push_back(point);
  }
  return cloud;
}

TEST(FrameCloud, sees_every_corner_of_a_box_and_fills_the_view) {
  const Intrinsics camera = intrinsics_from_fov(640, 480, 60);
  const float halves[3][3] = {{1, 1, 1}, {5, 0.1f, 2}, {0.1f, 3, 0.2f}};
  for (const auto& half : halves) {
    const Cloud cloud = box_cloud(half[0], half[1], half[2]);
    const Framing framing = frame_cloud(cloud, camera);
    double widest = 0;
    for (const Point& point : cloud) {
      const Eigen::Vector3d in_cam =
          framing.world_from_cam.inverse() * point.getVector3fMap().cast<double>();
      ASSERT_GT(in_cam.z(), 0);
      const Eigen::Vector2d pixel = camera.project(in_cam);
      EXPECT_TRUE(pixel.x() > 0 && pixel.x() < 639 && pixel.y() > 0 && pixel.y() < 479);
      widest =
          std::max({widest, std::abs(pixel.x() - 319.5) / 320, std::abs(pixel.y() - 239.5) / 240});
    }
    EXPECT_GT(widest, 0.7);
  }
}

TEST(FrameCloud, the_axis_that_is_up_is_up_in_the_picture) {
  const Intrinsics camera = intrinsics_from_fov(640, 480, 60);
  const Cloud cloud = box_cloud(1, 2, 3);
  const Eigen::Vector3d middle(10, 20, 30);
  for (const std::string up : {"x", "y", "z", "-x", "-y", "-z"}) {
    const Pose pose = frame_cloud(cloud, camera, up).world_from_cam;
    EXPECT_NO_THROW(checked_pose(pose.matrix(), up));
    const double sign = up.front() == '-' ? -1 : 1;
    const Eigen::Vector3d higher = middle + sign * 0.5 * Eigen::Vector3d::Unit(up.back() - 'x');
    const Eigen::Vector2d pixel = camera.project(pose.inverse() * higher);
    EXPECT_NEAR(pixel.x(), camera.cx, 1e-6) << up;
    EXPECT_LT(pixel.y(), camera.cy - 10) << up;
  }
  EXPECT_THROW(frame_cloud(cloud, camera, "w"), Error);
  EXPECT_THROW(frame_cloud(cloud, camera, ""), Error);
}

TEST(FrameCloud, by_default_y_is_up_and_x_to_the_right) {
  const Framing framing = frame_cloud(box_cloud(1, 1, 1), intrinsics_from_fov(64, 48, 60));
  const Eigen::Matrix3d expected = Eigen::Vector3d(1, -1, -1).asDiagonal();
  EXPECT_EQ(framing.world_from_cam.linear(), expected);
}

TEST(UpAxis, is_where_the_tops_of_the_cameras_point) {
  const Intrinsics camera = intrinsics_from_fov(640, 480, 60);
  for (const std::string up : {"x", "y", "z", "-x", "-y", "-z"}) {
    const Pose level = frame_cloud(box_cloud(1, 2, 3), camera, up).world_from_cam;
    EXPECT_EQ(up_axis(camera_path("circle", level)), up);
  }
  EXPECT_EQ(up_axis({}), "y");
}

TEST(FrameCloud, one_point_is_enough_and_none_is_an_error) {
  const Intrinsics camera = intrinsics_from_fov(640, 480, 60);
  EXPECT_GT(frame_cloud(box_cloud(0, 0, 0), camera).distance, 0);
  EXPECT_THROW(frame_cloud(Cloud(), camera), Error);
}

TEST(WithSize, keeps_the_horizontal_view_and_square_pixels) {
  const Intrinsics camera{540, 360, 495, 495, 269.5, 169};
  const Intrinsics square = with_size(camera, 270, 270);
  EXPECT_DOUBLE_EQ(square.fx, 247.5);
  EXPECT_DOUBLE_EQ(square.fy, 247.5);
  EXPECT_NEAR(square.lift(-0.5, 0, 1).x(), camera.lift(-0.5, 0, 1).x(), 1e-12);
  EXPECT_NEAR(square.lift(269.5, 0, 1).x(), camera.lift(539.5, 0, 1).x(), 1e-12);
  EXPECT_NEAR(square.lift(0, 134.5, 1).y(), camera.lift(0, 179.5, 1).y(), 1e-12);
  const Intrinsics same = with_size(camera, 540, 360);
  EXPECT_DOUBLE_EQ(same.cy, camera.cy);
}

}  // namespace
}  // namespace ps
