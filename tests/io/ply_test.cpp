// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply.h"

#include "io/cloud_file.h"
#include "tests/io/cloud_support.h"

namespace ps {
namespace {

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string header(const std::string& format, const std::string& rest) {
  return "ply\nformat " + format + " 1.0\n" + rest + "end_header\n";
}

std::string message(const std::string& bytes) {
  return error_of([&] { parse_ply(bytes, "a.ply"); });
}

TEST(Ply, what_is_written_reads_back_the_same) {
  const Folder folder;
  for (const std::size_t count : {0, 1, 2, 1000, 300000}) {
    const Cloud cloud = random_cloud(count, 7);
    write_ply(folder / "a.ply", cloud);
    expect_same(cloud, read_ply(folder / "a.ply"));
  }
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Ply, our_file_has_the_layout_of_the_design) {
  const Folder folder;
  Cloud cloud;
  cloud.resize(1);
  cloud[0].x = 1;
  cloud[0].y = -2;
  cloud[0].z = 3.5f;
  cloud[0].rgba = 0xff102030;
  cloud[0].footprint = 0.25f;
  cloud[0].view = 258;
  cloud[0].origin = 1;
  write_ply(folder / "a.ply", cloud);
  const std::string bytes = bytes_of(folder / "a.ply");
  const std::string properties =
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float scalar_footprint\nproperty ushort scalar_view\n"
      "property uchar scalar_origin\nend_header\n";
  EXPECT_TRUE(has(bytes, properties));
  EXPECT_TRUE(has(bytes, "comment units metres\n"));
  EXPECT_EQ(bytes.substr(bytes.find(properties) + properties.size()),
            raw(1.f) + raw(-2.f) + raw(3.5f) + "\x10\x20\x30" + raw(0.25f) +
                raw<std::uint16_t>(258) + "\x01");
}

TEST(Ply, ascii_with_short_colour_names_and_windows_line_ends) {
  std::string text = header("ascii", "comment by hand\nelement vertex 2\n" + kXyz +
                                         "property uchar r\nproperty uchar g\nproperty uchar b\n");
  text += "1 2 3 10 20 30\n\n  -1e-3\t.5 +6 255 0 1  \n";
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
    text.replace(at, 1, "\r\n");
  }
  const Cloud cloud = parse_ply(text, "a.ply");
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(rgb(cloud[0]), 0x0a141eu);
  EXPECT_EQ(cloud[1].x, -1e-3f);
  EXPECT_EQ(cloud[1].y, 0.5f);
  EXPECT_EQ(cloud[1].z, 6.f);
  EXPECT_EQ(rgb(cloud[1]), 0xff0001u);
}

TEST(Ply, big_endian_doubles_with_diffuse_colours_and_unknown_properties) {
  std::string bytes = header(
      "binary_big_endian",
      "element vertex 1\nproperty double x\nproperty float64 y\nproperty double z\n"
      "property float nx\nproperty uint8 diffuse_red\nproperty uint8 diffuse_green\n"
      "property uint8 diffuse_blue\nelement face 1\nproperty list uchar int vertex_indices\n");
  bytes += raw(1.5, true) + raw(-2.25, true) + raw(1e3, true) + raw(9.f, true) + "\x01\x02\x03";
  const Cloud cloud = parse_ply(bytes, "a.ply");  // the faces are not even there
  ASSERT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud[0].x, 1.5f);
  EXPECT_EQ(cloud[0].y, -2.25f);
  EXPECT_EQ(cloud[0].z, 1000.f);
  EXPECT_EQ(rgb(cloud[0]), 0x010203u);
}

TEST(Ply, colours_of_16_bits_and_of_floats_scale_to_8_bits) {
  std::string wide =
      header("binary_little_endian",
             "element vertex 1\n" + kXyz +
                 "property ushort red\nproperty ushort green\nproperty ushort blue\n");
  wide += raw(0.f) + raw(0.f) + raw(1.f) + raw<std::uint16_t>(65535) + raw<std::uint16_t>(257) +
          raw<std::uint16_t>(0);
  EXPECT_EQ(rgb(parse_ply(wide, "a")[0]), 0xff0100u);
  const std::string floats =
      header("ascii", "element vertex 1\n" + kXyz +
                          "property float red\nproperty float green\nproperty float blue\n");
  EXPECT_EQ(rgb(parse_ply(floats + "0 0 1 1.0 0.5 -3\n", "a")[0]), 0xff8000u);
}

TEST(Ply, points_without_colour_are_grey_and_observed) {
  const Cloud cloud = parse_ply(header("ascii", "element vertex 1\n" + kXyz) + "1 2 3\n", "a");
  EXPECT_EQ(rgb(cloud[0]), 0x808080u);
  EXPECT_EQ(cloud[0].origin, 0);
  EXPECT_EQ(cloud[0].footprint, 0.f);
}

TEST(Ply, our_scalars_are_read_from_any_type) {  // CloudCompare saves them all as float
  const std::string text =
      header("ascii", "element vertex 1\n" + kXyz +
                          "property float scalar_footprint\nproperty float scalar_view\n"
                          "property float scalar_origin\n");
  const Cloud cloud = parse_ply(text + "1 2 3 0.01 70000 1\n", "a");
  EXPECT_EQ(cloud[0].footprint, 0.01f);
  EXPECT_EQ(cloud[0].view, 65535);
  EXPECT_EQ(cloud[0].origin, 1);
}

TEST(Ply, elements_and_lists_before_and_among_vertices_are_passed_over) {
  const std::string elements =
      "element camera 2\nproperty float f\nproperty list uchar short bits\nelement vertex 2\n"
      "property float x\nproperty list int double extra\nproperty float y\nproperty float z\n";
  std::string bytes = header("binary_little_endian", elements);
  bytes += raw(5.f) + "\x02" + raw<short>(1) + raw<short>(2) + raw(6.f) + std::string(1, '\0');
  bytes += raw(1.f) + raw<int>(1) + raw(8.0) + raw(2.f) + raw(3.f);
  bytes += raw(4.f) + raw<int>(0) + raw(5.f) + raw(6.f);
  const std::string text = header("ascii", elements) + "5 2 1 2\n6 0\n1 1 8 2 3\n4 0 5 6\n";
  for (const Cloud& cloud : {parse_ply(bytes, "a"), parse_ply(text, "b")}) {
    ASSERT_EQ(cloud.size(), 2u);
    EXPECT_EQ(cloud[0].getVector3fMap(), Eigen::Vector3f(1, 2, 3));
    EXPECT_EQ(cloud[1].getVector3fMap(), Eigen::Vector3f(4, 5, 6));
  }
}

TEST(Ply, points_that_are_not_finite_are_dropped_and_counted) {
  const std::string text = header("ascii",
                                  "element vertex 4\nproperty double x\nproperty double y\n"
                                  "property double z\n");
  std::size_t dropped = 0;
  const Cloud cloud = parse_ply(text + "nan 0 0\n1 2 3\n0 -inf 0\n0 0 1e300\n", "a", &dropped);
  ASSERT_EQ(cloud.size(), 1u);
  EXPECT_EQ(dropped, 3u);
  EXPECT_EQ(cloud[0].z, 3.f);
  EXPECT_TRUE(cloud.is_dense);
}

TEST(Ply, headers_that_promise_too_much_are_refused_before_memory_is_taken) {
  for (const std::string count : {"1000000000", "18446744073709551615", "4294967297"}) {
    const std::string elements = "element vertex " + count + "\n" + kXyz;
    EXPECT_TRUE(
        has(message(header("binary_little_endian", elements) + "abc"), "promises " + count));
    EXPECT_TRUE(has(message(header("ascii", elements) + "1 2 3\n"), "promises " + count));
    const std::string lists =
        "element face " + count + "\nproperty list uchar int v\nelement vertex 1\n" + kXyz;
    EXPECT_TRUE(has(message(header("binary_little_endian", lists) + "abc"), "promises " + count));
  }
  const std::string list = "element face 1\nproperty list uint double v\nelement vertex 1\n" + kXyz;
  EXPECT_TRUE(
      has(message(header("binary_little_endian", list) + raw(0xffffffffu) + "abcdefghijklmno"),
          "a list"));
}

TEST(Ply, every_truncation_is_an_error) {
  const Folder folder;
  write_ply(folder / "a.ply", random_cloud(5, 1));
  const std::string whole = bytes_of(folder / "a.ply");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_TRUE(has(message(whole.substr(0, size)), "a.ply"));
  }
}

TEST(Ply, faults_are_named_with_their_line) {
  const std::string good = header("ascii", "element vertex 2\n" + kXyz);
  EXPECT_TRUE(has(message(good + "1 2 3\n1 zwei 3\n"), "a.ply:9: 'zwei'"));
  EXPECT_TRUE(has(message(good + "1 2 3\n1 2\n3 4 5\n"), "a.ply:9: the line ends"));
  EXPECT_TRUE(has(message(good + "1 2 3 4\n1 2 3\n"), "a.ply:8: the line has more"));
  EXPECT_TRUE(has(message(good + "1 2 3    \n    \n"), "1 of 2 points"));
  EXPECT_TRUE(has(message("PLY\n"), "'ply'"));
  EXPECT_TRUE(has(message(std::string(100, '\0')), "'ply'"));
  EXPECT_TRUE(has(message("ply\nelement vertex 1\n" + kXyz + "end_header\n"), "format"));
  EXPECT_TRUE(has(message(header("binary_middle_endian", "")), "a.ply:2: format 'binary_mid"));
  EXPECT_TRUE(
      has(message(header("ascii", "element vertex -5\n" + kXyz)), "a.ply:3: element count '-5'"));
  EXPECT_TRUE(has(message(header("ascii", "element face 5\n" + kXyz)), "no vertex element"));
  EXPECT_TRUE(has(
      message(header("ascii", "element vertex 1\nproperty float x\nproperty float y\n")), "no z"));
  EXPECT_TRUE(has(message(header("ascii", "property float x\n")), "a property of nothing"));
  EXPECT_TRUE(has(message(header("ascii", "element vertex 1\nproperty quad x\n")), "'quad'"));
  EXPECT_TRUE(
      has(message(header("ascii", "element vertex 1\nproperty list float int x\n")), "count"));
}

TEST(Ply, clouds_that_are_not_finite_are_not_written) {
  const Folder folder;
  Cloud cloud = random_cloud(3, 1);
  cloud[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(has(error_of([&] { write_ply(folder / "a.ply", cloud); }), "point 1"));
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Ply, missing_empty_and_odd_files_are_errors) {
  const Folder folder;
  put(folder / "empty.ply", "");
  EXPECT_TRUE(has(error_of([&] { read_ply(folder / "no.ply"); }), "no.ply"));
  EXPECT_TRUE(has(error_of([&] { read_ply(folder / "empty.ply"); }), "is empty"));
  EXPECT_TRUE(has(error_of([&] { read_ply(folder.path()); }), "is a folder"));
  EXPECT_TRUE(has(error_of([&] { read_ply("/dev/zero"); }), "device"));
  EXPECT_TRUE(has(error_of([&] { read_cloud(folder / "a.obj"); }), ".ply or .pcd"));
  EXPECT_TRUE(has(error_of([&] { write_cloud(folder / "a.obj", {}); }), ".ply or .pcd"));
}

}  // namespace
}  // namespace ps
