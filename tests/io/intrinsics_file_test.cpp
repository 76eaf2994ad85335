// SPDX-License-Identifier: BSD-3-Clause
#include "io/intrinsics_file.h"

#include "tests/io/support.h"

namespace ps {
namespace {

const Intrinsics kCamera{540, 360, 495.5677570093457, 495.25, 269.5, 169.19411214953};

void expect_same(const Intrinsics& a, const Intrinsics& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_NEAR(a.fx, b.fx, 1e-9);
  EXPECT_NEAR(a.fy, b.fy, 1e-9);
  EXPECT_NEAR(a.cx, b.cx, 1e-9);
  EXPECT_NEAR(a.cy, b.cy, 1e-9);
}

std::string message(const std::string& text, int width = 0, int height = 0) {
  return error_of([&] { parse_intrinsics(text, "k", width, height); });
}

TEST(IntrinsicsFile, every_kind_reads_back) {
  const Folder folder;
  for (const char* name : {"k.json", "cameras.txt", "k.txt"}) {
    write_intrinsics(folder / name, kCamera);
    expect_same(read_intrinsics(folder / name, 540, 360), kCamera);
  }
  expect_same(read_intrinsics(folder / "k.json"), kCamera);
  expect_same(read_intrinsics(folder / "cameras.txt"), kCamera);
  EXPECT_EQ(folder.entries(), 3);
}

TEST(IntrinsicsFile, open3d_json_is_column_major) {
  const std::string json = R"({"width": 540, "height": 360,
    "intrinsic_matrix": [500, 0, 0, 0, 510, 0, 270, 180, 1]})";
  expect_same(parse_intrinsics(json, "k"), {540, 360, 500, 510, 270, 180});
  expect_same(parse_intrinsics("{\"extrinsic\": [1], \"intrinsic\": " + json + "}", "k"),
              {540, 360, 500, 510, 270, 180});
  EXPECT_TRUE(has(message(R"({"width": 540, "height": 360,
    "intrinsic_matrix": [500, 0, 270, 0, 510, 180, 0, 0, 1]})"),
                  "column by column"));
}

TEST(IntrinsicsFile, colmaps_half_pixel_comes_off) {
  const std::string tail = "\n";
  for (const char* model :
       {"PINHOLE 540 360 500 510 270.5 180.5", "OPENCV 540 360 500 510 270.5 180.5 0 0 0 0"}) {
    expect_same(parse_intrinsics("# Camera list\n\n1 " + std::string(model) + tail, "k"),
                {540, 360, 500, 510, 270, 180});
  }
  for (const char* model :
       {"SIMPLE_PINHOLE 540 360 500 270.5 180.5", "SIMPLE_RADIAL 540 360 500 270.5 180.5 0",
        "RADIAL 540 360 500 270.5 180.5 0 0.0"}) {
    expect_same(parse_intrinsics("7 " + std::string(model), "k"), {540, 360, 500, 500, 270, 180});
  }
}

TEST(IntrinsicsFile, distortion_and_second_cameras_are_refused) {
  EXPECT_TRUE(has(message("1 SIMPLE_RADIAL 540 360 500 270 180 0.01"), "k:1: the lens distorts"));
  EXPECT_TRUE(has(message("1 OPENCV_FISHEYE 540 360 500 500 270 180 0 0 0 0"), "'OPENCV_FISHEYE'"));
  EXPECT_TRUE(has(message("1 PINHOLE 9 9 5 5 4 4\n2 PINHOLE 9 9 5 5 4 4"), "k:2: a second camera"));
  EXPECT_TRUE(has(message("1 PINHOLE 540 360 500 500 270"), "ends too early"));
  EXPECT_TRUE(has(message("1 PINHOLE 540 360 500 500 270 180 0"), "too many"));
  EXPECT_TRUE(has(message("1 PINHOLE -540 360 500 500 270 180"), "positive whole number"));
}

TEST(IntrinsicsFile, matrix_takes_the_photos_size) {
  const std::string text = "5.0e+02 0 270\r\n0 510 180\r\n0 0 1\r\n";
  expect_same(parse_intrinsics(text, "k", 540, 360), {540, 360, 500, 510, 270, 180});
  expect_same(parse_intrinsics("500 0 270 0 510 180 0 0 1", "k", 540, 360),
              {540, 360, 500, 510, 270, 180});
  EXPECT_TRUE(has(message(text), "width and height"));
  EXPECT_TRUE(has(message("500 0 270\n0 510 180\n", 540, 360), "ends too early"));
  EXPECT_TRUE(has(message("500 1 270\n0 510 180\n0 0 1", 540, 360), "no pinhole"));
  EXPECT_TRUE(has(message("500 0 270\n0 510 180\n0 0 1 7", 540, 360), "more than 9"));
  EXPECT_TRUE(has(message("500 0 270\n0 nan 180\n0 0 1", 540, 360), "k:2: "));
  EXPECT_TRUE(has(message("500 0 270\n0 five 180\n0 0 1", 540, 360), "k:2: 'five'"));
  EXPECT_TRUE(has(message("-500 0 270\n0 500 180\n0 0 1", 540, 360), "focal length"));
}

TEST(IntrinsicsFile, other_sizes_are_scaled_when_the_aspect_agrees) {
  const Folder folder;
  write_intrinsics(folder / "k.json", kCamera);
  expect_same(read_intrinsics(folder / "k.json", 1080, 720), resized(kCamera, 1080, 720));
  expect_same(read_intrinsics(folder / "k.json", 271, 180), resized(kCamera, 271, 180));  // rounded
  EXPECT_TRUE(
      has(error_of([&] { read_intrinsics(folder / "k.json", 360, 540); }), "is for 540x360"));
  EXPECT_TRUE(
      has(error_of([&] { read_intrinsics(folder / "k.json", 640, 480); }), "the same aspect"));
}

TEST(IntrinsicsFile, unsound_json_is_refused) {
  EXPECT_TRUE(has(message("{"), "JSON"));
  EXPECT_TRUE(has(message("{}"), "intrinsic_matrix"));
  EXPECT_TRUE(has(message(R"({"intrinsic_matrix": [1, 2]})"), "9 numbers"));
  EXPECT_TRUE(has(message(R"({"intrinsic_matrix": [1,0,0,0,1,0,0,0,"1"]})"), "a number"));
  EXPECT_TRUE(has(message(R"({"width": -4, "height": 3, "intrinsic_matrix": [1,0,0,0,1,0,0,0,1]})"),
                  "positive"));
  EXPECT_TRUE(
      has(message(R"({"width": 1e99, "height": 3, "intrinsic_matrix": [1,0,0,0,1,0,0,0,1]})"),
          "positive"));
  EXPECT_TRUE(has(message(R"({"width": 4, "width": 5})"), "twice"));
  EXPECT_TRUE(has(message("{\"a\":" + std::string(100000, '[')), "nests too deep"));
  EXPECT_TRUE(has(message("\xff\xfe{"), "k"));
}

TEST(IntrinsicsFile, every_truncation_is_an_error_or_a_shorter_number) {
  const Folder folder;
  write_intrinsics(folder / "k.json", kCamera);
  const std::string whole = bytes_of(folder / "k.json");
  for (std::size_t size = 1; size + 2 < whole.size(); ++size) message(whole.substr(0, size));
}

TEST(IntrinsicsFile, unsound_cameras_are_not_written) {
  const Folder folder;
  error_of([&] { write_intrinsics(folder / "k.json", {540, 360, 0, 500, 1, 1}); });
  error_of([&] { write_intrinsics(folder / "k.json", {0, 360, 500, 500, 1, 1}); });
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace ps
