// SPDX-License-Identifier: BSD-3-Clause
// pcl_fuse voxel|uniform DIR OUT.ply: fuses an RGB-D folder as a user of PCL would, as a peer for
// `pixelsynth fuse`: every frame lifted and accumulated, then pcl::VoxelGrid or
// pcl::UniformSampling. Prints one JSON object: frames, points, seconds (reading and fusing),
// load_seconds, write_seconds.
#include <pcl/common/common.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "held_out.h"
#include "io/cloud_file.h"
#include "libps/core/error.h"

namespace ps {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZRGB>;

struct Options {
  std::string method;
  std::string walk;
  std::string output;
  double leaf = 0.01;
  std::size_t hold_out = 0;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void accumulate(const View& view, PclCloud& cloud) {
  for (int y = 0; y < view.depth.rows; ++y) {
    for (int x = 0; x < view.depth.cols; ++x) {
      const float depth = view.depth(y, x);
      if (depth <= 0) continue;
      pcl::PointXYZRGB point;
      point.getVector3fMap() =
          (view.world_from_cam * view.intrinsics.lift(x, y, depth)).cast<float>();
      const cv::Vec3b rgb = view.color(y, x) * 255;
      point.r = rgb[0];
      point.g = rgb[1];
      point.b = rgb[2];
      cloud.push_back(point);
    }
  }
}

/// Both filters number their voxels in 32 bits; below some leaf they silently go wrong.
void check_leaf(const PclCloud& cloud, double leaf) {
  pcl::PointXYZRGB low, high;
  pcl::getMinMax3D(cloud, low, high);
  const Eigen::Vector3d size = (high.getVector3fMap() - low.getVector3fMap()).cast<double>();
  const Eigen::Vector3d voxels = (size / leaf).array().floor() + 1;
  if (voxels.prod() > std::numeric_limits<std::int32_t>::max()) {
    throw Error("--leaf", "PCL cannot number so many voxels", "a larger leaf");
  }
}

PclCloud filtered(const PclCloud::ConstPtr& cloud, const Options& options) {
  check_leaf(*cloud, options.leaf);
  const auto leaf = static_cast<float>(options.leaf);
  PclCloud result;
  if (options.method == "voxel") {
    pcl::VoxelGrid<pcl::PointXYZRGB> grid;
    grid.setInputCloud(cloud);
    grid.setLeafSize(leaf, leaf, leaf);
    grid.filter(result);
  } else {
    pcl::UniformSampling<pcl::PointXYZRGB> sampling;
    sampling.setInputCloud(cloud);
    sampling.setRadiusSearch(leaf);
    sampling.filter(result);
  }
  return result;
}

void write(const std::string& path, const PclCloud& points) {
  Cloud cloud;
  cloud.reserve(points.size());
  for (const pcl::PointXYZRGB& p : points) {
    Point point;
    point.getVector3fMap() = p.getVector3fMap();
    point.rgba = p.rgba;
    cloud.push_back(point);
  }
  write_cloud(path, cloud);
}

nlohmann::ordered_json fuse(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const RgbdFolder folder = open_rgbd_folder(options.walk);
  const std::vector<RgbdFrame> frames = chosen_frames(folder, options.hold_out, false);
  auto cloud = std::make_shared<PclCloud>();
  cloud->reserve(frames.size() * folder.intrinsics.width * folder.intrinsics.height);
  for (const RgbdFrame& frame : frames) accumulate(load_frame(folder, frame), *cloud);
  const double load_seconds = seconds_since(start);
  const PclCloud result = filtered(cloud, options);
  const double seconds = seconds_since(start);
  write(options.output, result);
  return {{"method", "pcl_" + options.method},
          {"leaf", options.leaf},
          {"frames", frames.size()},
          {"points", result.size()},
          {"seconds", seconds},
          {"load_seconds", load_seconds},
          {"write_seconds", seconds_since(start) - seconds}};
}

}  // namespace
}  // namespace ps

int main(int argc, char** argv) {
  ps::Options options;
  CLI::App app{"Fuses an RGB-D folder with PCL's filters, as a peer for pixelsynth fuse"};
  app.add_option("method", options.method)->required()->check(CLI::IsMember({"voxel", "uniform"}));
  app.add_option("walk", options.walk, "RGB-D folder")->required();
  app.add_option("output", options.output, "PLY or PCD")->required();
  app.add_option("--leaf", options.leaf, "metres")->check(CLI::PositiveNumber);
  app.add_option("--hold-out", options.hold_out,
                 "leave out frames with index % N == N / 2; 0 = none");
  CLI11_PARSE(app, argc, argv);
  try {
    std::cout << ps::fuse(options) << std::endl;
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "pcl_fuse: " << error.what() << std::endl;
    return 1;
  }
}
