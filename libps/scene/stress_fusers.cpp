// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/stress_fusers.h"

#include <pcl/common/common.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>

#include <algorithm>

#include "libps/core/error.h"
#include "libps/eval/statistics.h"
#include "libps/scene/frame_study.h"

namespace ps::stress {
namespace {

ViewSource source_of(const std::vector<View>& frames) {
  return {frames.size(), [&frames](std::size_t i) { return frames[i]; }};
}

Cloud all_points(const std::vector<View>& frames) {
  LiftOptions all;
  all.edge_footprints = 0;
  Cloud cloud;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].depth.empty()) continue;
    cloud += lift(frames[i], static_cast<std::uint16_t>(i), Origin::observed, all);
  }
  return cloud;
}

float median_footprint(const Cloud& cloud) {
  std::vector<double> all;
  for (const Point& point : cloud) all.push_back(point.footprint);
  return static_cast<float>(median(std::move(all)));
}

}  // namespace

Cloud voxel_grid(const Cloud& cloud, float leaf) {
  pcl::PointCloud<pcl::PointXYZRGB>::Ptr all(new pcl::PointCloud<pcl::PointXYZRGB>);
  for (const Point& point : cloud) {
    pcl::PointXYZRGB p(point.r, point.g, point.b);
    p.getVector3fMap() = point.getVector3fMap();
    all->push_back(p);
  }
  pcl::PointCloud<pcl::PointXYZRGB> thinned;
  pcl::VoxelGrid<pcl::PointXYZRGB> filter;
  filter.setInputCloud(all);
  pcl::PointXYZRGB low, high;
  pcl::getMinMax3D(*all, low, high);
  // It numbers its cells in 32 bits.
  leaf = std::max(leaf, (high.getVector3fMap() - low.getVector3fMap()).maxCoeff() / 1000);
  filter.setLeafSize(leaf, leaf, leaf);
  filter.filter(thinned);
  Cloud result;
  for (const auto& p : thinned) {
    Point point;
    point.getVector3fMap() = p.getVector3fMap();
    point.r = p.r;
    point.g = p.g;
    point.b = p.b;
    point.footprint = leaf;
    result.push_back(point);
  }
  return result;
}

Cloud fuse_by(const std::string& method, const std::vector<View>& frames) {
  if (method == kOurs) {
    const ViewSource source = source_of(frames);
    const FrameStudy study = study_frames(source);
    return fuse(heeding(source, study), heeding(FuseOptions(), study));
  }
  if (method == kOursUnguarded) {
    FuseOptions options;
    options.cloud.lift.edge_footprints = 0;
    return fuse(source_of(frames), options);
  }
  const Cloud cloud = all_points(frames);
  if (method == kAllPoints || cloud.empty()) return cloud;
  if (method == kVoxelGrid) return voxel_grid(cloud, median_footprint(cloud));
  throw Error("stress", "no way to fuse is called " + method);
}

}  // namespace ps::stress
