// SPDX-License-Identifier: BSD-3-Clause
#include "io/posed_frames.h"

#include <chrono>
#include <cmath>
#include <set>

#include "io/depth_file.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "libps/core/parallel.h"
#include "libps/eval/pairs.h"
#include "tests/io/support.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

Image grey(int i, cv::Size size = {12, 8}) {
  const float level = static_cast<float>(i) / 10;
  return {size, cv::Vec3f(level, level, level)};
}

/// Whether it is photo i, and its depth d metres everywhere.
void expect_frame(const View& view, int i, float d) {
  EXPECT_NEAR(view.color(4, 4)[0], i / 10.0, 0.003);
  ASSERT_EQ(view.depth.size(), view.color.size());
  EXPECT_NEAR(view.depth(4, 4), d, 1e-4);
  EXPECT_EQ(view.intrinsics.width, view.color.cols);
}

struct RgbdFolder : Folder {
  RgbdFolder() {
    fs::create_directory(path() / "color");
    fs::create_directory(path() / "depth");
    write_intrinsics(path() / "intrinsics.json", {12, 8, 10, 10, 5.5, 3.5});
    for (const int i : {1, 2}) {
      write_image(path() / ("color/" + std::to_string(i) + ".png"), grey(i));
      write_depth(path() / ("depth/" + std::to_string(i) + ".png"), Depth(8, 12, 1.f * i));
    }
    put(path() / "trajectory.txt", "2 0 0 2 0 0 0 1\n1 0 0 1 0 0 0 1\n9 0 0 9 0 0 0 1\n");
  }
};

TEST(PosedFrames, of_an_rgbd_folder) {
  const RgbdFolder folder;
  const PosedFrames frames = open_posed_frames(folder.path().string());
  EXPECT_EQ(frames.layout, "RGB-D folder");
  ASSERT_EQ(frames.frames.size(), 2u);
  EXPECT_EQ(frames.skipped, 1u);
  EXPECT_TRUE(frames.assumed.empty());
  for (const int i : {1, 2}) {
    const PosedFrame& frame = frames.frames[static_cast<std::size_t>(i - 1)];
    EXPECT_EQ(frame.name, std::to_string(i));
    EXPECT_EQ(frame.stamp, i);
    EXPECT_EQ(frames.pose(static_cast<std::size_t>(i - 1)).translation().z(), i);
    const View view = frames.load(static_cast<std::size_t>(i - 1));
    EXPECT_EQ(view.intrinsics.fx, 10);
    expect_frame(view, i, static_cast<float>(i));
    EXPECT_EQ(view.world_from_cam.translation().z(), i);
  }
  EXPECT_NEAR(open_posed_frames(folder.path().string(), 500).load(0).depth(0, 0), 2, 1e-6);
}

TEST(PosedFrames, without_any_depth_in_a_frame_have_zeros) {
  const RgbdFolder folder;
  write_depth(folder / "depth/1.png", Depth::zeros(8, 12));
  const View view = open_posed_frames(folder.path().string()).load(0);
  EXPECT_EQ(view.color.cols, 12);
  EXPECT_EQ(cv::countNonZero(view.depth), 0);
  EXPECT_EQ(view.depth.size(), view.color.size());
}

TEST(PosedFrames, load_photos_and_depths_of_other_sizes_with_their_lens) {
  const RgbdFolder folder;
  write_image(folder / "color/1.png", grey(1, {24, 16}));
  const View view = open_posed_frames(folder.path().string()).load(0);
  EXPECT_EQ(view.intrinsics.fx, 20);
  EXPECT_EQ(view.depth.size(), cv::Size(24, 16));
  write_image(folder / "color/1.png", grey(1, {24, 24}));
  EXPECT_TRUE(has(error_of([&] { open_posed_frames(folder.path().string()).load(0); }), "1.png"));
}

/// Photo i, of 64x48 pixels, at i seconds, i from 1 to 3.
struct TumFolder : Folder {
  TumFolder() {
    fs::create_directory(path() / "rgb");
    fs::create_directory(path() / "depth");
    for (const int i : {1, 2, 3}) {
      write_image(path() / ("rgb/" + std::to_string(i) + ".000000.png"), grey(i, {64, 48}));
      write_depth(path() / ("depth/" + std::to_string(i) + ".010000.png"),
                  Depth(48, 64, 0.5f * static_cast<float>(i)), 5000);
    }
    put(path() / "rgb.txt",
        "# color images\n# file: 'x.bag'\n# timestamp filename\n1.000000 rgb/1.000000.png\n"
        "2.000000 rgb/2.000000.png\n3.000000 rgb/3.000000.png\n");
    put(path() / "depth.txt",
        "# depth maps\n1.010000 depth/1.010000.png\n2.010000 depth/2.010000.png\n"
        "3.010000 depth/3.010000.png\n");
    std::string poses = "# ground truth trajectory\n";
    for (int i = 95; i < 320; ++i) {
      const std::string stamp = std::to_string(i / 100.0 + 0.004);
      poses += stamp + " " + stamp + " 0 0 0 0 0 1\n";
    }
    put(path() / "groundtruth.txt", poses);
  }
};

TEST(PosedFrames, of_tum_go_together_by_time) {
  const TumFolder folder;
  const PosedFrames frames = open_posed_frames(folder.path().string());
  EXPECT_EQ(frames.layout, "TUM RGB-D");
  ASSERT_EQ(frames.frames.size(), 3u);
  EXPECT_EQ(frames.skipped, 0u);
  ASSERT_EQ(frames.assumed.size(), 1u);
  EXPECT_TRUE(has(frames.assumed[0], "525 pixels of 640x480"));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(frames.frames[i].stamp, static_cast<double>(i + 1));
    // Poses stand at 0.994, 1.004, ...: the nearest is 4 ms later.
    EXPECT_NEAR(frames.pose(i).translation().x(), i + 1.004, 1e-6);
    const View view = frames.load(i);
    expect_frame(view, static_cast<int>(i) + 1, 0.5f * static_cast<float>(i + 1));
    EXPECT_EQ(view.intrinsics.fx, 52.5);
    EXPECT_DOUBLE_EQ(view.intrinsics.cx, 31.5);
  }
}

TEST(PosedFrames, of_tum_take_the_lens_that_is_there) {
  const TumFolder folder;
  write_intrinsics(folder / "intrinsics.json", {64, 48, 50, 51, 31, 23});
  const PosedFrames frames = open_posed_frames(folder.path().string());
  EXPECT_TRUE(frames.assumed.empty());
  EXPECT_EQ(frames.load(0).intrinsics.fy, 51);
}

TEST(PosedFrames, of_tum_leave_out_what_is_too_far_apart_and_use_each_depth_once) {
  const TumFolder folder;
  // Two photos want the depth at 1.01 s: the nearer one has it. At 2 s there is no pose.
  put(folder / "rgb.txt",
      "1.000000 rgb/1.000000.png\n1.008000 rgb/2.000000.png\n3.000000 rgb/3.000000.png\n");
  put(folder / "depth.txt", "1.010000 depth/1.010000.png\n3.021000 depth/3.010000.png\n");
  const PosedFrames frames = open_posed_frames(folder.path().string());
  ASSERT_EQ(frames.frames.size(), 1u);
  EXPECT_EQ(frames.frames[0].stamp, 1.008);
  EXPECT_EQ(frames.skipped, 2u);
  put(folder / "groundtruth.txt", "7 0 0 0 0 0 0 1\n");
  EXPECT_TRUE(has(error_of([&] { open_posed_frames(folder.path().string()); }), "no frame"));
}

TEST(PosedFrames, of_a_broken_tum_folder_name_the_file_and_the_line) {
  const TumFolder folder;
  const auto error = [&] { return error_of([&] { open_posed_frames(folder.path().string()); }); };
  put(folder / "rgb.txt", "# x\n1.0 rgb/1.png\nnext rgb/2.png\n");
  EXPECT_TRUE(has(error(), "rgb.txt:3"));
  put(folder / "rgb.txt", "1.0\n");
  EXPECT_TRUE(has(error(), "no file name"));
  put(folder / "rgb.txt", "1.0 a.png\n1.0 b.png\n");
  EXPECT_TRUE(has(error(), "there already"));
  put(folder / "rgb.txt", "1.0 rgb/absent.png\n");
  const PosedFrames frames = open_posed_frames(folder.path().string());
  EXPECT_TRUE(has(error_of([&] { frames.load(0); }), "absent.png"));
  fs::remove(folder / "depth.txt");
  EXPECT_TRUE(has(error(), "depth.txt"));
}

const char* const kPose = "1 0 0 0.5\n0\t1\t0\t-2\n0 0 1 3\n0 0 0 1\n";

void add_scene_frame(const fs::path& folder, int i) {
  const std::string name = "frame-00000" + std::to_string(i);
  fs::create_directories(folder);
  write_image(folder / (name + ".color.png"), grey(i, {64, 48}));
  Depth depth(48, 64, static_cast<float>(i));
  depth(0, 0) = 65.535f;
  write_depth(folder / (name + ".depth.png"), depth);
  put(folder / (name + ".pose.txt"), kPose);
}

TEST(PosedFrames, of_seven_scenes) {
  const Folder folder;
  for (const int i : {3, 4, 5}) add_scene_frame(folder.path(), i);
  fs::remove(folder / "frame-000004.depth.png");
  const PosedFrames frames = open_posed_frames(folder.path().string());
  EXPECT_EQ(frames.layout, "7-Scenes");
  ASSERT_EQ(frames.frames.size(), 2u);
  EXPECT_EQ(frames.skipped, 1u);
  EXPECT_EQ(frames.frames[1].name, "frame-000005");
  EXPECT_EQ(frames.frames[1].stamp, 5);
  EXPECT_EQ(frames.pose(1).translation(), Eigen::Vector3d(0.5, -2, 3));
  EXPECT_TRUE(has(frames.assumed.at(0), "585 pixels of 640x480"));
  const View view = frames.load(1);
  expect_frame(view, 5, 5);
  EXPECT_EQ(view.depth(0, 0), 0) << "65535 is unknown";
  EXPECT_EQ(view.intrinsics.fx, 58.5);
}

TEST(PosedFrames, of_seven_scenes_sequences_are_one_world_with_stamps_of_their_own) {
  const Folder folder;
  for (const int i : {0, 1}) add_scene_frame(folder / "seq-01", i);
  for (const int i : {0, 2}) add_scene_frame(folder / "seq-02", i);
  const PosedFrames frames = open_posed_frames(folder.path().string());
  ASSERT_EQ(frames.frames.size(), 4u);
  EXPECT_EQ(frames.frames[3].name, "seq-02/frame-000002");
  std::set<double> stamps;
  for (const PosedFrame& frame : frames.frames) {
    EXPECT_EQ(frame.world, 0);
    stamps.insert(frame.stamp);
  }
  EXPECT_EQ(stamps, (std::set<double>{0, 1, 2, 4}));
}

TEST(PosedFrames, of_broken_seven_scenes_name_the_pose) {
  const Folder folder;
  add_scene_frame(folder.path(), 1);
  const auto error = [&] { return error_of([&] { open_posed_frames(folder.path().string()); }); };
  for (const char* text :
       {"1 0 0 0\n0 1 0 0\n0 0 1 0\n", "1 0 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n",
        "1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "1 0 0 0\n0 -1 0 0\n0 0 1 0\n0 0 0 1\n",
        "1 0 0 -1.#IND\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"}) {
    put(folder / "frame-000001.pose.txt", text);
    EXPECT_TRUE(has(error(), "frame-000001.pose.txt")) << text;
  }
  fs::remove(folder / "frame-000001.pose.txt");
  EXPECT_TRUE(has(error(), "no frame of 7-Scenes is whole"));
}

/// Frames at 1000 and 2000, the second a metre to the right.
struct EstateFolder : Folder {
  EstateFolder() {
    const std::string lens = " 0.5 0.75 0.5 0.5 0 0 ";
    put(path() / "clip.txt", "https://example.invalid/clip\n1000" + lens +
                                 "1 0 0 0 0 1 0 0 0 0 1 0\n2000" + lens +
                                 "1 0 0 -1 0 1 0 0 0 0 1 0\n");
  }
  void photos(const std::string& folder, const std::vector<std::string>& stems) const {
    fs::create_directories(path() / folder);
    int i = 0;
    for (const std::string& stem : stems) {
      write_image(path() / folder / (stem + ".png"), grey(++i));
    }
  }
};

TEST(PosedFrames, of_realestate10k_have_no_depth_and_lenses_in_pixels) {
  for (const char* photos : {"clip", "frames", ""}) {
    const EstateFolder folder;
    folder.photos(photos, {"2000", "1000"});
    for (const fs::path& data : {folder.path(), folder / "clip.txt"}) {
      const PosedFrames frames = open_posed_frames(data.string());
      EXPECT_EQ(frames.layout, "RealEstate10K");
      ASSERT_EQ(frames.frames.size(), 2u);
      EXPECT_EQ(frames.frames[1].name, "2000");
      EXPECT_EQ(frames.pose(1).translation().x(), 1);
      const View view = frames.load(1);
      EXPECT_TRUE(view.depth.empty());
      EXPECT_NEAR(view.color(0, 0)[0], 0.1, 0.003);
      EXPECT_EQ(view.intrinsics.fx, 6);
      EXPECT_EQ(view.intrinsics.fy, 6);
      EXPECT_EQ(view.intrinsics.cx, 5.5);
      EXPECT_EQ(view.intrinsics.cy, 3.5);
    }
  }
}

TEST(PosedFrames, of_realestate10k_go_by_order_where_names_are_no_timestamps) {
  const EstateFolder folder;
  folder.photos("clip", {"b10", "b9"});
  const PosedFrames frames = open_posed_frames(folder.path().string());
  EXPECT_EQ(frames.frames.at(0).name, "b9");
  folder.photos("clip", {"b11"});
  EXPECT_TRUE(
      has(error_of([&] { open_posed_frames(folder.path().string()); }), "3 photos of 2 frames"));
}

TEST(PosedFrames, of_broken_realestate10k_say_what_is_wrong) {
  const EstateFolder folder;
  const auto error = [&] { return error_of([&] { open_posed_frames(folder.path().string()); }); };
  EXPECT_TRUE(has(error(), "no image"));
  folder.photos("clip", {"1000", "3"});
  EXPECT_EQ(open_posed_frames(folder.path().string()).skipped, 1u);
  put(folder / "other.txt", "https://example.invalid/other\n");
  EXPECT_TRUE(has(error(), "2 lists"));
  fs::remove(folder / "other.txt");
  put(folder / "clip.txt", "https://example.invalid/clip\n1000 0.5 0.75 0.5\n");
  EXPECT_TRUE(has(error(), "clip.txt:2"));
}

TEST(PosedFrames, of_rooms_are_exact_views_four_to_a_world) {
  const PosedFrames frames = open_posed_frames("rooms:7:6");
  EXPECT_EQ(frames.layout, "rooms");
  ASSERT_EQ(frames.frames.size(), 6u);
  std::set<std::string> names;
  for (std::size_t i = 0; i < 6; ++i) {
    const PosedFrame& frame = frames.frames[i];
    EXPECT_EQ(frame.world, i < 4 ? 0 : 1);
    EXPECT_TRUE(names.insert(frame.name).second);
    if (i < 3) continue;  // a room is built for each
    const View view = frames.load(i);
    check(view, "room");
    EXPECT_EQ(view.color.size(), cv::Size(256, 256));
    EXPECT_EQ(view.world_from_cam.matrix(), frames.pose(i).matrix());
  }
  // The poses go with the depths: hardly a surface is where the other view looks through.
  const View first = frames.load(0), second = frames.load(1);
  const Visibility found = true_visibility(first, second);
  const Mask contradicted = (1 - found.visible - found.invisible) & (second.depth > 0);
  EXPECT_GT(cv::mean(found.visible)[0], 0.2);
  EXPECT_LT(cv::countNonZero(contradicted), 0.02 * 256 * 256);
}

TEST(PosedFrames, of_rooms_do_not_depend_on_threads_but_on_the_seed) {
  const auto place = [](const std::string& data) {
    return open_posed_frames(data).pose(8).matrix();
  };
  const Eigen::Matrix4d one = place("rooms:7:9");
  std::vector<Eigen::Matrix4d> many(6);
  set_threads(3);
  parallel_for(many.size(), [&](std::size_t i) { many[i] = place("rooms:7:9"); });
  set_threads(0);
  for (const Eigen::Matrix4d& again : many) EXPECT_EQ(again, one);
  EXPECT_NE(place("rooms:8:9"), one);
}

TEST(PosedFrames, of_rooms_are_built_when_they_are_asked_for) {
  const auto start = std::chrono::steady_clock::now();
  const PosedFrames frames = open_posed_frames("rooms:7:200000");
  EXPECT_EQ(frames.frames.size(), 200000u);
  EXPECT_EQ(frames.frames.back().world, 49999);
  EXPECT_EQ(frames.load(199999).world_from_cam.matrix(), frames.pose(199999).matrix());
  // Fifty thousand rooms take minutes.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(PosedFrames, of_nothing_known_throw) {
  const Folder folder;
  for (const char* data : {"rooms:", "rooms:1", "rooms:1:0", "rooms:-1:4", "rooms:1:4:2",
                           "rooms:1:9999999999", "rooms:99999999999999999:4"}) {
    EXPECT_TRUE(has(error_of([&] { open_posed_frames(data); }), "rooms:SEED:COUNT")) << data;
  }
  EXPECT_TRUE(has(error_of([&] { open_posed_frames((folder / "absent").string()); }), "absent"));
  EXPECT_TRUE(has(error_of([&] { open_posed_frames(folder.path().string()); }), "no known layout"));
  put(folder / "a.txt", "");
  EXPECT_TRUE(
      has(error_of([&] { open_posed_frames((folder / "a.txt").string()); }), "no known layout"));
  EXPECT_THROW(open_posed_frames(""), Error);
}

}  // namespace
}  // namespace ps
