// SPDX-License-Identifier: BSD-3-Clause
#include "io/rgbd_folder.h"

#include "io/depth_file.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "tests/io/support.h"

namespace ps {
namespace {

/// A folder of frames of 12x8 pixels; frame i is grey i / 10 and 1 + i metres deep.
struct Frames : Folder {
  Frames() {
    std::filesystem::create_directory(path() / "color");
    std::filesystem::create_directory(path() / "depth");
    write_intrinsics(path() / "intrinsics.json", {12, 8, 10, 10, 5.5, 3.5});
  }
  void add(const std::string& stem, int i) const {
    const float grey = static_cast<float>(i) / 10;
    write_image(path() / "color" / (stem + ".png"), Image(8, 12, cv::Vec3f(grey, grey, grey)));
    write_depth(path() / "depth" / (stem + ".png"), Depth(8, 12, 1.f + static_cast<float>(i)));
  }
  void poses(const std::vector<std::string>& stamps) const {
    std::string text;
    for (const std::string& stamp : stamps) text += stamp + " 0 0 " + stamp + " 0 0 0 1\n";
    put(path() / "trajectory.txt", text);
  }
};

TEST(RgbdFolder, timestamps_name_the_files_whatever_their_zeros) {
  Frames frames;
  for (const int i : {1, 2, 3}) frames.add("0000" + std::to_string(i), i);
  frames.poses({"3", "1", "2", "9"});  // out of order, and one without files
  std::size_t skipped = 0;
  const RgbdFolder folder = open_rgbd_folder(frames.path(), &skipped);
  ASSERT_EQ(folder.frames.size(), 3u);
  EXPECT_EQ(skipped, 1u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(folder.frames[i].timestamp, i + 1);
    const View view = load_frame(folder, folder.frames[i]);
    EXPECT_NEAR(view.color(4, 4)[0], (i + 1) / 10.0, 0.003);
    EXPECT_NEAR(view.depth(4, 4), i + 2, 1e-6);
    EXPECT_EQ(view.world_from_cam.translation().z(), i + 1);
    EXPECT_EQ(view.intrinsics.fx, 10);
  }
}

TEST(RgbdFolder, other_names_go_by_order_when_counts_agree) {
  Frames frames;
  for (const int i : {2, 9, 10}) frames.add("frame" + std::to_string(i), i);
  put(frames / "color/.hidden.png", "x");
  put(frames / "color/Thumbs.db", "x");
  frames.poses({"100.5", "200", "300"});
  const RgbdFolder folder = open_rgbd_folder(frames.path());
  ASSERT_EQ(folder.frames.size(), 3u);
  EXPECT_EQ(folder.frames[0].color.filename(), "frame2.png");
  EXPECT_EQ(folder.frames[2].depth.filename(), "frame10.png");
  frames.poses({"100", "200"});
  EXPECT_TRUE(
      has(error_of([&] { open_rgbd_folder(frames.path()); }), "3 photos, 3 depths, 2 poses"));
}

TEST(RgbdFolder, depth_of_another_size_is_resized_to_the_photo) {
  Frames frames;
  frames.add("1", 1);
  frames.poses({"1"});
  Depth small(4, 6);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) small(y, x) = static_cast<float>(1 + y * 6 + x);
  }
  write_depth(frames / "depth/1.png", small);
  RgbdFolder folder = open_rgbd_folder(frames.path());
  FrameNotes notes;
  const View view = load_frame(folder, folder.frames[0], 1000, &notes);
  EXPECT_TRUE(notes.scaled);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 12; ++x) EXPECT_EQ(view.depth(y, x), small(y / 2, x / 2));
  }
  write_depth(frames / "depth/1.png", Depth(8, 12, 1.f));
  load_frame(folder, folder.frames[0], 1000, &notes);
  EXPECT_FALSE(notes.scaled);
  write_depth(frames / "depth/1.png", Depth(8, 8, 1.f));
  EXPECT_TRUE(
      has(error_of([&] { load_frame(folder, folder.frames[0]); }), "depth is 8x8, the photo 12x8"));
}

TEST(RgbdFolder, a_few_pixels_of_another_aspect_are_no_resized_depth) {
  Frames frames;
  frames.add("1", 1);
  frames.poses({"1"});
  const RgbdFolder folder = open_rgbd_folder(frames.path());
  const auto load = [&](int width, int height) {
    write_depth(frames / "depth/1.png", Depth(height, width, 1.f));
    load_frame(folder, folder.frames[0]);
  };
  load(3, 2);
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 1), std::pair(4, 3)}) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    EXPECT_TRUE(
        has(error_of([&, w = width, h = height] { load(w, h); }), "depth is " + size + ", the"));
  }
}

TEST(RgbdFolder, sides_may_differ_by_a_pixel_s_rounding) {
  EXPECT_TRUE(same_aspect({4032, 3024}, {258, 194}));  // 258 x 193.5
  EXPECT_TRUE(same_aspect({258, 194}, {4032, 3024}));
  EXPECT_FALSE(same_aspect({4032, 3024}, {258, 196}));
  EXPECT_FALSE(same_aspect({9, 7}, {4032, 3024}));  // within a pixel, but 4 % off
  EXPECT_TRUE(same_aspect({1, 1}, {64, 64}));
}

TEST(RgbdFolder, a_frame_without_depth_is_told_where_asked_else_an_error) {
  Frames frames;
  frames.add("1", 1);
  frames.add("2", 2);
  frames.poses({"1", "2"});
  const RgbdFolder folder = open_rgbd_folder(frames.path());
  write_depth(frames / "depth/1.png", Depth::zeros(8, 12));
  FrameNotes notes;
  EXPECT_TRUE(load_frame(folder, folder.frames[0], 1000, &notes).depth.empty());
  EXPECT_TRUE(notes.without_depth);
  EXPECT_FALSE(load_frame(folder, folder.frames[1], 1000, &notes).depth.empty());
  EXPECT_FALSE(notes.without_depth);
  EXPECT_TRUE(has(error_of([&] { load_frame(folder, folder.frames[0]); }), "no pixel has a depth"));
}

TEST(RgbdFolder, depth_need_not_be_there_where_it_is_not_asked_for) {
  Frames frames;
  for (const int i : {1, 2}) frames.add(std::to_string(i), i);
  frames.poses({"1", "2"});
  std::filesystem::remove_all(frames.path() / "depth");
  EXPECT_TRUE(has(error_of([&] { open_rgbd_folder(frames.path()); }), "depth: is no folder"));
  const RgbdFolder folder = open_rgbd_folder(frames.path(), nullptr, false);
  ASSERT_EQ(folder.frames.size(), 2u);
  FrameNotes notes;
  const View view = load_frame(folder, folder.frames[1], 1000, &notes);
  EXPECT_TRUE(notes.without_depth);
  EXPECT_NEAR(view.color(4, 4)[0], .2, .003);
  EXPECT_EQ(view.depth.size(), view.color.size());
  EXPECT_EQ(cv::countNonZero(view.depth), 0);
  EXPECT_EQ(view.intrinsics.fx, 10);
}

TEST(RgbdFolder, intrinsics_of_another_size_are_scaled) {
  Frames frames;
  frames.add("1", 1);
  frames.poses({"1"});
  write_intrinsics(frames / "intrinsics.json", {24, 16, 20, 20, 11.5, 7.5});
  RgbdFolder folder = open_rgbd_folder(frames.path());
  EXPECT_NEAR(load_frame(folder, folder.frames[0]).intrinsics.cx, 5.5, 1e-12);
  folder.intrinsics.height = 24;
  EXPECT_TRUE(
      has(error_of([&] { load_frame(folder, folder.frames[0]); }), "intrinsics are for 24x24"));
}

TEST(RgbdFolder, missing_parts_are_named) {
  const auto message = [](const Frames& frames) {
    return error_of([&] { open_rgbd_folder(frames.path()); });
  };
  Frames frames;
  EXPECT_TRUE(has(message(frames), "trajectory.txt"));
  frames.poses({"1"});
  EXPECT_TRUE(has(message(frames), "color: holds no image"));
  frames.add("1", 1);
  frames.add("01", 1);
  EXPECT_TRUE(has(message(frames), "another image has its number"));
  std::filesystem::remove(frames / "intrinsics.json");
  EXPECT_TRUE(has(message(frames), "intrinsics.json"));
  EXPECT_TRUE(has(error_of([&] { open_rgbd_folder(frames / "no"); }), "is no folder"));
  std::filesystem::remove_all(frames / "depth");
  write_intrinsics(frames / "intrinsics.json", {12, 8, 10, 10, 5.5, 3.5});
  std::filesystem::remove(frames / "color/01.png");
  EXPECT_TRUE(has(message(frames), "depth: is no folder"));
}

TEST(RgbdFolder, a_file_that_goes_missing_is_an_error) {
  Frames frames;
  frames.add("1", 1);
  frames.poses({"1"});
  const RgbdFolder folder = open_rgbd_folder(frames.path());
  put(frames / "depth/1.png", "damaged");
  EXPECT_TRUE(has(error_of([&] { load_frame(folder, folder.frames[0]); }), "depth/1.png"));
  std::filesystem::remove(frames / "color/1.png");
  EXPECT_TRUE(has(error_of([&] { load_frame(folder, folder.frames[0]); }), "color/1.png"));
}

TEST(RgbdFolder, the_shared_walk_loads) {
  PS_NEED_SHARED("rgbd/walk");
  std::size_t skipped = 9;
  const RgbdFolder folder = open_rgbd_folder(shared("rgbd/walk"), &skipped);
  EXPECT_EQ(folder.frames.size(), 373u);
  EXPECT_EQ(skipped, 0u);
  const View view = load_frame(folder, folder.frames[100]);
  EXPECT_EQ(view.color.size(), cv::Size(540, 360));
  EXPECT_EQ(view.depth.size(), cv::Size(540, 360));
  EXPECT_NEAR(cv::countNonZero(view.depth) / (540.0 * 360), 0.7, 0.2);  // a hole is 0: about 30 %
}

}  // namespace
}  // namespace ps
