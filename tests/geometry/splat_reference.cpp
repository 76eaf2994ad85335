// SPDX-License-Identifier: BSD-3-Clause
#include "tests/geometry/splat_reference.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace ps {
namespace {

struct Hit {
  float z;
  int index;
  float d2;
  bool operator<(const Hit& other) const {
    return std::tie(z, index) < std::tie(other.z, other.index);
  }
};

void blend(const std::vector<Hit>& hits, const PlanePoints& points, const SplatOptions& options,
           int x, int y, Splat* out) {
  const double r2 = static_cast<double>(options.radius) * options.radius;
  double left = 1, depth = 0;
  cv::Vec3d color(0, 0, 0);
  int used = 0;
  for (const Hit& hit : hits) {
    if (used == options.points_per_pixel) break;
    if (used < 4) out->nearest(y, x)[used] = hit.index;
    const double alpha = 1 - std::sqrt(std::clamp(hit.d2 / r2, 1e-3, 1.0));
    color += alpha * left * cv::Vec3d(points.color[hit.index]);
    depth += alpha * left * hit.z;
    left *= 1 - alpha;
    ++used;
  }
  if (options.renormalise && used > 0) {
    color = left < 1 ? color / (1 - left) : cv::Vec3d(0, 0, 0);
  } else {
    color += left * cv::Vec3d(options.background);
  }
  out->color(y, x) = color;
  out->hit(y, x) = used > 0;
  out->count(y, x) = used;
  out->first_depth(y, x) = used ? hits[0].z : 0;
  out->expected_depth(y, x) = left < 1 ? depth / (1 - left) : out->first_depth(y, x);
}

void dilate(const Mask& hit, int side, Mask* missing) {
  missing->create(hit.size());
  for (int y = 0; y < hit.rows; ++y) {
    for (int x = 0; x < hit.cols; ++x) {
      bool any = false;
      for (int v = std::max(0, y - side / 2); v <= std::min(hit.rows - 1, y + side / 2); ++v) {
        for (int u = std::max(0, x - side / 2); u <= std::min(hit.cols - 1, x + side / 2); ++u) {
          any |= hit(v, u) == 0;
        }
      }
      (*missing)(y, x) = any;
    }
  }
}

}  // namespace

Splat splat_reference(const PlanePoints& points, cv::Size size, const SplatOptions& options) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr plane(new pcl::PointCloud<pcl::PointXYZ>);
  std::vector<int> index_of;
  for (std::size_t i = 0; i < points.u.size(); ++i) {
    const bool drawn = points.z[i] > options.near && std::isfinite(points.z[i]) &&
                       std::isfinite(points.u[i]) && std::isfinite(points.v[i]);
    if (!drawn) continue;
    plane->push_back({points.u[i], points.v[i], 0});
    index_of.push_back(static_cast<int>(i));
  }
  Splat out;
  out.color = Image(size, cv::Vec3f(options.background));
  out.first_depth = Depth(size, 0.f);
  out.expected_depth = Depth(size, 0.f);
  out.hit = Mask(size, 0);
  out.count = cv::Mat1i(size, 0);
  out.nearest.create(size);
  out.nearest.setTo(cv::Scalar::all(-1));
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  if (!plane->empty()) tree.setInputCloud(plane);
  for (int y = 0; y < size.height && !plane->empty(); ++y) {
    for (int x = 0; x < size.width; ++x) {
      std::vector<int> found;
      std::vector<float> distance;
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      tree.radiusSearch({fx, fy, 0}, options.radius * 1.01, found, distance);
      std::vector<Hit> hits;
      for (const int f : found) {
        const float dx = fx - (*plane)[f].x, dy = fy - (*plane)[f].y;
        const float d2 = dx * dx + dy * dy;
        if (d2 < options.radius * options.radius) {
          hits.push_back({points.z[index_of[f]], index_of[f], d2});
        }
      }
      std::sort(hits.begin(), hits.end());
      blend(hits, points, options, x, y, &out);
    }
  }
  dilate(out.hit, options.dilation, &out.missing);
  return out;
}

}  // namespace ps
