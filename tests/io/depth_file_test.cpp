// SPDX-License-Identifier: BSD-3-Clause
#include "io/depth_file.h"

#include <opencv2/imgcodecs.hpp>

#include "tests/io/support.h"

namespace ps {
namespace {

Depth random_depth(int width, int height, double scale) {
  std::mt19937 random(2);
  Depth depth(height, width);
  for (float& d : depth) d = static_cast<float>((random() % 60000) / scale);
  return depth;
}

Depth depth_of(int rows, const std::vector<float>& values) {
  return Depth(values, true).reshape(1, rows).clone();
}

std::string encoded(const char* extension, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes);
  return {bytes.begin(), bytes.end()};
}

std::string message(const std::string& bytes, double scale = 1000) {
  return error_of([&] { parse_depth(bytes, "d", scale); });
}

/// Rows from the bottom up, as the format says.
std::string pfm(bool big_endian, const std::vector<float>& values, const std::string& size) {
  std::string bytes = "Pf\n" + size + "\n" + (big_endian ? "1.0" : "-1.0") + "\n";
  for (const float value : values) bytes += raw(value, big_endian);
  return bytes;
}

TEST(DepthFile, png_reads_back_at_any_scale) {
  const Folder folder;
  for (const double scale : {1000.0, 5000.0, 256.0}) {
    const Depth depth = random_depth(31, 17, scale);
    write_depth(folder / "d.png", depth, scale);
    EXPECT_LE(cv::norm(depth, read_depth(folder / "d.png", scale), cv::NORM_INF), 1e-5);
  }
  EXPECT_EQ(folder.entries(), 1);
}

TEST(DepthFile, pfm_reads_back_every_bit) {
  const Folder folder;
  const Depth depth = random_depth(31, 17, 777);
  write_depth(folder / "d.pfm", depth);
  EXPECT_EQ(cv::norm(depth, read_depth(folder / "d.pfm"), cv::NORM_INF), 0);
}

TEST(DepthFile, pfm_rows_go_upwards_in_either_byte_order) {
  for (const bool big_endian : {false, true}) {
    for (const char* size : {"3 2", "3\n2", "3\r\n2"}) {
      const Depth depth = parse_depth(pfm(big_endian, {4, 5, 6, 1, 2, 3}, size), "d");
      EXPECT_EQ(cv::norm(depth, depth_of(2, {1, 2, 3, 4, 5, 6}), cv::NORM_INF), 0);
    }
  }
}

TEST(DepthFile, float_tiff_and_exr_are_metres) {
  const Depth depth = random_depth(13, 7, 1000);
  for (const char* extension : {".tiff", ".exr"}) {
    EXPECT_EQ(cv::norm(depth, parse_depth(encoded(extension, depth), "d", 5000), cv::NORM_INF), 0);
  }
}

TEST(DepthFile, unknown_is_zero) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              inf = std::numeric_limits<float>::infinity();
  const Depth depth = parse_depth(pfm(false, {nan, inf, -inf, -1, 0, 2}, "6 1"), "d");
  EXPECT_EQ(cv::norm(depth, depth_of(1, {0, 0, 0, 0, 0, 2}), cv::NORM_INF), 0);
  const Folder folder;
  write_depth(folder / "d.png", depth_of(1, {nan, -3, 0, 2}));
  EXPECT_EQ(cv::norm(read_depth(folder / "d.png"), depth_of(1, {0, 0, 0, 2}), cv::NORM_INF), 0);
}

TEST(DepthFile, other_kinds_of_pixels_are_refused_by_name) {
  EXPECT_TRUE(has(message(encoded(".png", cv::Mat1b(4, 4, 9))), "has 8 bits"));
  EXPECT_TRUE(has(message(encoded(".png", cv::Mat3b(4, 4, cv::Vec3b(9, 9, 9)))), "has colours"));
  EXPECT_TRUE(has(message(encoded(".jpg", cv::Mat1b(8, 8, 9))), "has 8 bits"));
  EXPECT_TRUE(has(message("PF\n1 1\n-1\n" + std::string(12, 'a')), "colour PFM"));
}

TEST(DepthFile, depth_that_is_nowhere_is_an_error) {
  EXPECT_TRUE(has(message(encoded(".png", cv::Mat1w(4, 4, static_cast<ushort>(0)))),
                  "no pixel has a depth"));
  const std::string none = pfm(false, {-1, 0}, "2 1");
  EXPECT_TRUE(has(message(none), "no pixel has a depth"));
  const Depth allowed = parse_depth(none, "d", 1000, NoDepth::allow);
  EXPECT_EQ(cv::norm(allowed, depth_of(1, {0, 0}), cv::NORM_INF), 0);
}

TEST(DepthFile, every_truncation_is_an_error) {
  const Depth depth = random_depth(20, 10, 1000);
  cv::Mat1w millimetres;
  depth.convertTo(millimetres, CV_16U, 1000);
  for (const std::string& whole :
       {encoded(".png", millimetres), encoded(".pfm", depth), encoded(".tiff", depth)}) {
    EXPECT_EQ(parse_depth(whole, "d").size(), depth.size());
    for (std::size_t size = 0; size < whole.size() - 200; ++size) message(whole.substr(0, size));
  }
  const std::string whole = encoded(".pfm", depth);
  EXPECT_TRUE(has(message(whole.substr(0, whole.size() - 1)), "199 of 200 pixels"));
}

TEST(DepthFile, unsound_headers_are_errors) {
  for (const char* size : {"0 5", "-3 2", "1e9 1", "x y", "3", "", "99999999999 1"}) {
    EXPECT_TRUE(has(message(pfm(false, {1, 2, 3}, size)), "header is unsound"));
  }
  EXPECT_TRUE(
      has(message(pfm(false, {1}, "2000000000 2000000000")), "of 4000000000000000000 pixels"));
  EXPECT_TRUE(has(message("Pf\n1 1\n0\nabcd"), "header is unsound"));
  EXPECT_TRUE(has(message("Pf\n1 1\nnan\nabcd"), "header is unsound"));
}

TEST(DepthFile, scales_are_positive) {
  for (const double scale : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_TRUE(has(message(pfm(false, {1}, "1 1"), scale), "depth scale"));
  }
}

TEST(DepthFile, depth_that_does_not_fit_leaves_no_file) {
  const Folder folder;
  const Depth deep(2, 2, 66.f);
  EXPECT_TRUE(has(error_of([&] { write_depth(folder / "d.png", deep); }), "does not fit 16 bits"));
  EXPECT_TRUE(has(error_of([&] { write_depth(folder / "d.jpg", deep); }), "'.jpg'"));
  EXPECT_TRUE(has(error_of([&] { write_depth(folder / "d.pfm", Depth()); }), "no pixels"));
  EXPECT_TRUE(has(error_of([&] { write_depth(folder / "no/d.pfm", deep); }), "folder"));
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace ps
