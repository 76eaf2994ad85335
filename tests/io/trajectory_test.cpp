// SPDX-License-Identifier: BSD-3-Clause
#include "io/trajectory.h"

#include "tests/io/support.h"

namespace ps {
namespace {

std::vector<StampedPose> random_poses(int count) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<StampedPose> poses(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    poses[i].timestamp = 3 + 2 * i;
    poses[i].world_from_cam.linear() = q.normalized().toRotationMatrix();
    poses[i].world_from_cam.translation() << normal(random), normal(random), normal(random);
    poses[i].normalised_intrinsics = Eigen::Vector4d(0.9, 1.4, 0.5, 0.5);
  }
  return poses;
}

std::string message(const std::string& text, const std::string& name = "t") {
  return error_of([&] { parse_trajectory(text, name); });
}

const std::pair<TrajectoryFormat, const char*> kFormats[] = {
    {TrajectoryFormat::tum, "trajectory.txt"},
    {TrajectoryFormat::colmap_images, "images.txt"},
    {TrajectoryFormat::open3d_log, "trajectory.log"},
    {TrajectoryFormat::realestate10k, "clip.txt"}};

TEST(Trajectory, every_format_reads_back) {
  const Folder folder;
  const std::vector<StampedPose> poses = random_poses(50);
  for (const auto& [format, name] : kFormats) {
    write_trajectory(folder / name, poses, format);
    for (const std::string given : {name, "other.txt"}) {  // also told by content alone
      const std::vector<StampedPose> back = parse_trajectory(bytes_of(folder / name), given);
      ASSERT_EQ(back.size(), poses.size()) << name;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        EXPECT_EQ(back[i].timestamp, poses[i].timestamp) << name;
        EXPECT_TRUE(back[i].world_from_cam.isApprox(poses[i].world_from_cam, 1e-12)) << name;
      }
    }
  }
  EXPECT_EQ(folder.entries(), 4);
}

TEST(Trajectory, tum_is_camera_to_world_with_w_last) {
  const auto poses =
      parse_trajectory("# a comment\r\n1305031102.1753 1 2 3 0 0 0.70710678 0.70710678\r\n", "t");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].timestamp, 1305031102.1753);
  const Eigen::Vector3d point =
      poses[0].world_from_cam * Eigen::Vector3d(1, 0, 0);  // 90 degrees about z
  EXPECT_TRUE(point.isApprox(Eigen::Vector3d(1, 3, 3), 1e-8));
}

TEST(Trajectory, colmap_is_world_to_camera_with_w_first) {
  const std::string line = " 0.70710678 0 0 0.70710678 1 2 3 1 a photo.jpg";
  for (const std::string& points :
       {std::string("\n\n"), std::string("\n1.5 2.5 -1 4 5 6\n"), std::string("\n")}) {
    const std::string text = "# IMAGE_ID ...\n4" + line + points + "5" + line + points;
    const auto poses = parse_trajectory(text, "images.txt");
    ASSERT_EQ(poses.size(), 2u);
    EXPECT_EQ(poses[1].name, "a photo.jpg");
    EXPECT_EQ(poses[1].timestamp, 5);
    const Eigen::Vector3d in_cam = poses[1].world_from_cam.inverse() * Eigen::Vector3d(1, 0, 0);
    EXPECT_TRUE(in_cam.isApprox(Eigen::Vector3d(1, 3, 3), 1e-8));
  }
}

TEST(Trajectory, colmap_images_without_a_name_are_named_by_their_number) {
  const Folder folder;
  std::vector<StampedPose> poses = random_poses(2);
  poses[1].name = "left/7.png";
  write_trajectory(folder / "images.txt", poses, TrajectoryFormat::colmap_images);
  auto back = read_trajectory(folder / "images.txt");
  EXPECT_EQ(back[0].name, "00003.png");
  EXPECT_EQ(back[1].name, "left/7.png");
  poses[1].timestamp = poses[0].timestamp;  // no longer numbers of images
  write_trajectory(folder / "images.txt", poses, TrajectoryFormat::colmap_images);
  back = read_trajectory(folder / "images.txt");
  EXPECT_EQ(back[0].timestamp, 1);
  EXPECT_EQ(back[1].timestamp, 2);
}

TEST(Trajectory, open3d_log_is_camera_to_world) {
  const auto poses = parse_trajectory("7 7 8\n1 0 0 4\n0 1 0 5\n0 0 1 6\n0 0 0 1\n", "a.log");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].timestamp, 7);
  EXPECT_EQ(poses[0].world_from_cam.translation(), Eigen::Vector3d(4, 5, 6));
}

TEST(Trajectory, realestate10k_is_world_to_camera_with_shares_of_the_image) {
  const std::string text =
      "https://www.youtube.com/watch?v=x\n"
      "158692000 0.474 0.843 0.5 0.4 0.0 0.0 1 0 0 4 0 1 0 5 0 0 1 6\n";
  const auto poses = parse_trajectory(text, "0000cc6d8b108390.txt");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].timestamp, 158692000);
  EXPECT_EQ(poses[0].world_from_cam.translation(), Eigen::Vector3d(-4, -5, -6));
  EXPECT_EQ(*poses[0].normalised_intrinsics, Eigen::Vector4d(0.474, 0.843, 0.5, 0.4));
}

TEST(Trajectory, poses_that_are_none_are_named_with_their_line) {
  EXPECT_TRUE(
      has(message("1 0 0 0 0 0 0 1\n\n2 nan 0 0 0 0 0 1\n"), "t:3: a position is not finite"));
  EXPECT_TRUE(has(message("1 inf 0 0 0 0 0 1\n"), "t:1: a position is not finite"));
  EXPECT_TRUE(has(message("1 0 0 0 0 0 0 0\n"), "t:1: a quaternion of length 0"));
  EXPECT_TRUE(has(message("1 0 0 0 9 9 9 9\n"), "t:1: a quaternion of length 18"));
  EXPECT_TRUE(has(message("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n"), "t:2: the line ends too early"));
  EXPECT_TRUE(has(message("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1 5\n"), "t:2: the line is too long"));
  EXPECT_TRUE(has(message("1 0 0 0 0 0 0 one\n"), "t:1: 'one'"));
  EXPECT_TRUE(has(message("1 2 3 4\n"), "t:1: 4 columns"));
  EXPECT_TRUE(has(message("\n# nothing\n"), "holds no pose"));
  EXPECT_TRUE(has(message(""), "holds no pose"));
  EXPECT_TRUE(has(message(std::string(50, '\0')), "t:1: "));
  EXPECT_TRUE(has(message("http://x\n"), "holds no pose"));
  EXPECT_TRUE(has(message("1 1 0 0 0 0 0 0 1\n", "images.txt"), "images.txt:1: no image name"));
}

TEST(Trajectory, a_timestamp_that_comes_twice_is_named_with_its_line) {
  EXPECT_TRUE(has(message("7.25 0 0 0 0 0 0 1\n# 7.25\n8 0 0 0 0 0 0 1\n7.25 1 0 0 0 0 0 1\n"),
                  "t:4: timestamp 7.25 is there already"));
  EXPECT_TRUE(has(message("3 1 0 0 0 0 0 0 1 a\n\n3 1 0 0 0 0 0 0 1 b\n\n", "images.txt"),
                  "images.txt:3: timestamp 3 is there already"));
  const std::string matrix = "1 0 0 4\n0 1 0 5\n0 0 1 6\n0 0 0 1\n";
  EXPECT_TRUE(has(message("0 0 1\n" + matrix + "0 0 2\n" + matrix, "t.log"),
                  "t.log:6: timestamp 0 is there already"));
  const std::string shot = "5 .9 1.4 .5 .5 0 0 1 0 0 4 0 1 0 5 0 0 1 6\n";
  EXPECT_TRUE(has(message("https://x\n" + shot + shot), "t:3: timestamp 5 is there already"));
}

TEST(Trajectory, matrices_that_are_no_rotations_are_refused) {
  EXPECT_TRUE(has(message("0 0 1\n2 0 0 4\n0 2 0 5\n0 0 2 6\n0 0 0 1\n"), "not a rotation"));
  EXPECT_TRUE(has(message("0 0 1\n1 0 0 4\n0 1 0 5\n0 0 -1 6\n0 0 0 1\n"), "not a rotation"));
  EXPECT_TRUE(has(message("0 0 1\n1 0 0 4\n0 1 0 5\n0 0 1 6\n0 0 1 1\n"), "last row"));
  EXPECT_TRUE(has(message("0 0 1\n1 0 0 4\n0 1 0 5\n"), "incomplete"));
  EXPECT_TRUE(has(message("1 1 1 .5 .5 0 0 1 1 1 1 1 1 1 1 1 1 1 1\n"), "t:1: "));
  EXPECT_TRUE(has(message("1 0 1 .5 .5 0 0 1 0 0 0 0 1 0 0 0 0 1 0\n"), "focal lengths"));
}

TEST(Trajectory, truncations_never_do_worse_than_an_error) {
  const Folder folder;
  for (const auto& [format, name] : kFormats) {
    write_trajectory(folder / name, random_poses(3), format);
    const std::string whole = bytes_of(folder / name);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      try {
        EXPECT_LE(parse_trajectory(whole.substr(0, size), name).size(), 3u);
      } catch (const Error&) {
      }
    }
  }
}

TEST(Trajectory, unsound_poses_are_not_written) {
  const Folder folder;
  std::vector<StampedPose> poses = random_poses(3);
  poses[1].world_from_cam.linear() *= 2;
  for (const auto& [format, name] : kFormats) {
    EXPECT_TRUE(has(error_of([&, f = format] { write_trajectory(folder / "t.txt", poses, f); }),
                    "rotation"));
  }
  poses = random_poses(3);
  poses[2].timestamp = std::nan("");
  error_of([&] { write_trajectory(folder / "t.txt", poses); });
  poses = random_poses(3);
  poses[2].timestamp = poses[0].timestamp;
  EXPECT_TRUE(has(error_of([&] { write_trajectory(folder / "t.txt", poses); }), "one timestamp"));
  poses = random_poses(3);
  poses[2].normalised_intrinsics.reset();
  EXPECT_TRUE(has(
      error_of([&] { write_trajectory(folder / "t.txt", poses, TrajectoryFormat::realestate10k); }),
      "needs intrinsics"));
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Trajectory, the_shared_walk_reads) {
  PS_NEED_SHARED("rgbd/walk");
  const auto poses = read_trajectory(shared("rgbd/walk/trajectory.txt"));
  EXPECT_EQ(poses.size(), 373u);
  EXPECT_EQ(poses.front().timestamp, 3);
}

}  // namespace
}  // namespace ps
