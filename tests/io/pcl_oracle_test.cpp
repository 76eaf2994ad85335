// SPDX-License-Identifier: BSD-3-Clause
// PCL's own readers and writers against ours.
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include "io/pcd.h"
#include "io/ply.h"
#include "tests/io/cloud_support.h"

namespace ps {
namespace {

using Coloured = pcl::PointCloud<pcl::PointXYZRGB>;

template <class A, class B>
void expect_same_points(const A& a, const B& b, float tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_NEAR(a[i].x, b[i].x, tolerance);
    ASSERT_NEAR(a[i].y, b[i].y, tolerance);
    ASSERT_NEAR(a[i].z, b[i].z, tolerance);
    ASSERT_EQ(a[i].rgba & 0xffffff, b[i].rgba & 0xffffff) << i;
  }
}

Coloured random_coloured(std::size_t count) {
  Coloured cloud;
  for (const Point& point : random_cloud(count, 11).points) {
    cloud.push_back({point.x, point.y, point.z, point.r, point.g, point.b});
  }
  return cloud;
}

TEST(PclOracle, pcl_reads_our_pcd) {
  const Folder folder;
  const Cloud cloud = random_cloud(3000, 5);
  for (const bool compressed : {false, true}) {
    write_pcd(folder / "a.pcd", cloud, compressed);
    Coloured theirs;
    ASSERT_EQ(pcl::io::loadPCDFile((folder / "a.pcd").string(), theirs), 0);
    expect_same_points(theirs, cloud, 0);
  }
}

TEST(PclOracle, pcl_reads_our_ply) {
  const Folder folder;
  const Cloud cloud = random_cloud(3000, 5);
  write_ply(folder / "a.ply", cloud);
  Coloured theirs;
  ASSERT_EQ(pcl::PLYReader().read((folder / "a.ply").string(), theirs), 0);
  expect_same_points(theirs, cloud, 0);
}

TEST(PclOracle, we_read_pcls_pcd) {
  const Folder folder;
  const Coloured cloud = random_coloured(3000);
  const std::string path = (folder / "a.pcd").string();
  pcl::PCDWriter writer;
  ASSERT_EQ(writer.writeASCII(path, cloud, 9), 0);
  expect_same_points(read_pcd(path), cloud, 1e-5f);
  ASSERT_EQ(writer.writeBinary(path, cloud), 0);
  expect_same_points(read_pcd(path), cloud, 0);
  ASSERT_EQ(writer.writeBinaryCompressed(path, cloud), 0);
  expect_same_points(read_pcd(path), cloud, 0);
  pcl::PCLPointCloud2 blob;  // keeps the padding of the point type
  pcl::toPCLPointCloud2(cloud, blob);
  ASSERT_EQ(writer.writeBinary(path, blob), 0);
  expect_same_points(read_pcd(path), cloud, 0);
  ASSERT_EQ(writer.writeBinaryCompressed(path, blob), 0);
  expect_same_points(read_pcd(path), cloud, 0);
}

TEST(PclOracle, we_read_pcls_ply) {
  const Folder folder;
  const Coloured cloud = random_coloured(3000);
  const std::string path = (folder / "a.ply").string();
  pcl::PLYWriter writer;
  ASSERT_EQ(writer.write(path, cloud, true), 0);
  expect_same_points(read_ply(path), cloud, 0);
  ASSERT_EQ(writer.write(path, cloud, false), 0);
  expect_same_points(read_ply(path), cloud, 1e-4f);
}

}  // namespace
}  // namespace ps
