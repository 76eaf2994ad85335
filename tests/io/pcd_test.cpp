// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd.h"

#include "io/cloud_file.h"
#include "tests/io/cloud_support.h"

namespace ps {
namespace {

std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   const std::string& counts, int points, const std::string& data) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types +
         "\nCOUNT " + counts + "\nWIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n +
         "\nDATA " + data + "\n";
}

std::string xyz(int points, const std::string& data) {
  return header("x y z", "4 4 4", "F F F", "1 1 1", points, data);
}

std::string message(const std::string& bytes) {
  return error_of([&] { parse_pcd(bytes, "a.pcd"); });
}

TEST(Pcd, what_is_written_reads_back_the_same) {
  const Folder folder;
  for (const bool compressed : {false, true}) {
    for (const std::size_t count : {0, 1, 1000, 50000}) {
      const Cloud cloud = random_cloud(count, 3);
      write_pcd(folder / "a.pcd", cloud, compressed);
      expect_same(cloud, read_cloud(folder / "a.pcd"));
    }
  }
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Pcd, ascii_colours_are_integers_or_the_float_of_their_bits) {
  const std::string text = header("x y z rgb", "4 4 4 4", "F F F F", "1 1 1 1", 4, "ascii") +
                           "0 0 1 4278202128\n0 0 1 4.2108e+06\n0 0 1 1.4821387e-38\n0 0 1 nan\r\n";
  const Cloud cloud = parse_pcd(text, "a.pcd");
  ASSERT_EQ(cloud.size(), 4u);
  EXPECT_EQ(rgb(cloud[0]), 4278202128u & 0xffffff);
  EXPECT_EQ(rgb(cloud[1]), 4210800u);
  std::uint32_t bits;
  const float packed = 1.4821387e-38f;
  std::memcpy(&bits, &packed, 4);
  EXPECT_EQ(rgb(cloud[2]), bits & 0xffffff);
  EXPECT_EQ(rgb(cloud[3]), 0x808080u);
}

TEST(Pcd, extra_fields_arrays_and_padding_are_passed_over) {
  std::string bytes = header("x _ y z histogram rgba label", "4 1 8 4 4 4 8", "F U F F F U I",
                             "1 4 1 1 3 1 1", 2, "binary");
  for (const float x : {1.f, 2.f}) {
    bytes += raw(x) + "pad!" + raw(2.0 * x) + raw(3 * x) + std::string(12, 'h') + raw(0xff112233u) +
             raw<std::int64_t>(-1);
  }
  const Cloud cloud = parse_pcd(bytes, "a.pcd");
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud[1].getVector3fMap(), Eigen::Vector3f(2, 4, 6));
  EXPECT_EQ(rgb(cloud[1]), 0x112233u);
}

TEST(Pcd, rows_of_an_organised_cloud_become_one_and_holes_are_dropped_and_counted) {
  std::string bytes = xyz(4, "binary");
  bytes.replace(bytes.find("WIDTH 4\nHEIGHT 1"), 16, "WIDTH 2\nHEIGHT 2");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float x : {1.f, nan, 3.f, 4.f}) bytes += raw(x) + raw(x) + raw(x);
  std::size_t dropped = 0;
  const Cloud cloud = parse_pcd(bytes, "a.pcd", &dropped);
  EXPECT_EQ(dropped, 1u);
  EXPECT_EQ(cloud.width, 3u);
  EXPECT_EQ(cloud[1].x, 3.f);
}

TEST(Pcd, a_packed_colour_of_another_size_is_ignored) {
  const std::string bytes = header("x y z rgb", "4 4 4 1", "F F F U", "1 1 1 1", 1, "binary");
  const Cloud cloud = parse_pcd(bytes + raw(1.f) + raw(2.f) + raw(3.f) + "c", "a.pcd");
  EXPECT_EQ(rgb(cloud[0]), 0x808080u);
}

TEST(Pcd, every_truncation_is_an_error) {
  const Folder folder;
  for (const bool compressed : {false, true}) {
    write_pcd(folder / "a.pcd", random_cloud(20, 1), compressed);
    const std::string whole = bytes_of(folder / "a.pcd");
    for (std::size_t size = 0; size < whole.size(); size += size < 300 ? 1 : 7) {
      EXPECT_TRUE(has(message(whole.substr(0, size)), "a.pcd"));
    }
  }
}

TEST(Pcd, says_the_same_as_ply) {
  const Folder folder;
  for (const std::string up : {"", "y", "-y"}) {
    for (const bool compressed : {false, true}) {
      write_cloud(folder / "a.pcd", random_cloud(20, 1), up, compressed);
      write_cloud(folder / "a.ply", random_cloud(20, 1), up);
      const std::string pcd = bytes_of(folder / "a.pcd"), ply = bytes_of(folder / "a.ply");
      EXPECT_TRUE(has(pcd, cloud_comments(up, "# ", "") + "VERSION"));
      EXPECT_TRUE(has(ply, cloud_comments(up, "comment ", "scalar_") + "element"));
      EXPECT_TRUE(has(pcd, compressed ? "DATA binary_compressed\n" : "DATA binary\n"));
    }
  }
}

TEST(Pcd, headers_that_promise_too_much_are_refused_before_memory_is_taken) {
  EXPECT_TRUE(has(message(xyz(1000000000, "binary") + "abc"), "promises 1000000000"));
  EXPECT_TRUE(has(message(xyz(1000000000, "ascii") + "1 2 3\n"), "promises 1000000000"));
  const std::string block = raw(3u) + raw(4000000000u) + "abc";
  EXPECT_TRUE(has(message(xyz(1000000000, "binary_compressed") + block), "promises 1000000000"));
  std::string large = xyz(1, "binary");
  large.replace(large.find("WIDTH 1\nHEIGHT 1"), 16, "WIDTH 4294967295\nHEIGHT 4294967295");
  large.erase(large.find("POINTS 1\n"), 9);
  EXPECT_TRUE(has(message(large), "promises 18446744065119617025"));
}

TEST(Pcd, damaged_compression_is_an_error) {
  const Folder folder;
  write_pcd(folder / "a.pcd", random_cloud(500, 1), true);
  const std::string whole = bytes_of(folder / "a.pcd");
  const std::size_t block = whole.find("binary_compressed\n") + 18;
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {  // may read as another cloud, may throw; nothing else
    std::string bytes = whole;
    bytes[block + random() % (bytes.size() - block)] = static_cast<char>(random());
    try {
      EXPECT_LE(parse_pcd(bytes, "a.pcd").size(), 500u);
    } catch (const Error&) {
    }
  }
}

TEST(Pcd, faults_are_named_with_their_line) {
  EXPECT_TRUE(has(message("ply\n"), "a.pcd:1: header line 'ply'"));
  EXPECT_TRUE(has(message(xyz(1, "base64")), "DATA 'base64'"));
  EXPECT_TRUE(has(message(xyz(-1, "ascii")), "a.pcd:7: '-1'"));
  EXPECT_TRUE(has(message(xyz(2, "ascii") + "1 2 3\n1 2 x\n"), "a.pcd:13: 'x'"));
  EXPECT_TRUE(has(message(header("x y", "4 4", "F F", "1 1", 1, "ascii")), "no field z"));
  EXPECT_TRUE(has(message(header("x y z", "4 4 3", "F F F", "1 1 1", 1, "ascii")), "'F3'"));
  EXPECT_TRUE(
      has(message(header("x y z", "4 4", "F F F", "1 1 1", 1, "ascii")), "a.pcd:4: the line ends"));
  EXPECT_TRUE(has(message(header("x y z", "4 4 4", "F F FF", "1 1 1", 1, "ascii")), "'?4'"));
  std::string differ = xyz(2, "ascii");
  differ.replace(differ.find("WIDTH 2"), 7, "WIDTH 3");
  EXPECT_TRUE(has(message(differ), "WIDTH times HEIGHT"));
}

TEST(Pcd, clouds_that_are_not_finite_are_not_written) {
  const Folder folder;
  Cloud cloud = random_cloud(3, 1);
  cloud[2].x = std::numeric_limits<float>::infinity();
  error_of([&] { write_cloud(folder / "a.pcd", cloud); });
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace ps
