// SPDX-License-Identifier: BSD-3-Clause
// The second step of deduplication: what a view's pixels do not share a depth with may still be
// near.
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "libps/core/parallel.h"
#include "libps/geometry/view_match.h"

namespace ps {

void ViewMatch::drop_near_neighbours(Mask* candidates) const {
  Mask beside(candidates->size(), std::uint8_t{0});
  const std::vector<const Point*> points = points_beside(*candidates, &beside);
  if (!points.empty()) drop_near_points(points, beside, candidates);
  if (options_.spacing > 0 || options_.spacing_footprints > 1) thin(candidates);
}

/// The points that may be within the spacing of a candidate, and which candidates those are: the
/// rest need not go through the KD-tree.
std::vector<const Point*> ViewMatch::points_beside(const Mask& candidates, Mask* beside) const {
  Mask near;
  cv::copyMakeBorder(candidates, near, kMargin, kMargin, kMargin, kMargin, cv::BORDER_CONSTANT);
  cv::dilate(near, near, cv::Mat1b(2 * reach_ + 3, 2 * reach_ + 3, 1));
  std::vector<std::vector<const Point*>> found(seen_.size());
  parallel_for(seen_.size(), [&](std::size_t c) {
    for (const Seen& seen : seen_[c]) {
      const int x = nearest_pixel(seen.u) + kMargin, y = nearest_pixel(seen.v) + kMargin;
      if (near(y, x) && this->beside(seen, candidates, beside)) found[c].push_back(seen.point);
    }
  });
  std::vector<const Point*> points;
  for (const auto& some : found) points.insert(points.end(), some.begin(), some.end());
  return points;
}

/// Marks the candidates that the point may be too near to; returns whether there are any.
bool ViewMatch::beside(const Seen& seen, const Mask& candidates, Mask* beside) const {
  const float reach =
      static_cast<float>(reach_) + 0.5f;  // more than the spacing spans, for rounding
  const int x0 = std::max(0, ceil_of(seen.u - reach));
  const int y0 = std::max(0, ceil_of(seen.v - reach));
  const int x1 = std::min(candidates.cols - 1, floor_of(seen.u + reach));
  const int y1 = std::min(candidates.rows - 1, floor_of(seen.v + reach));
  bool any = false;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const float d = pixel(x, y).depth;
      if (!candidates(y, x) || std::fabs(seen.z - d) > 1.01f * spacing(d)) continue;
      __atomic_store_n(&(*beside)(y, x), std::uint8_t{1}, __ATOMIC_RELAXED);
      any = true;
    }
  }
  return any;
}

void ViewMatch::drop_near_points(const std::vector<const Point*>& points, const Mask& beside,
                                 Mask* candidates) const {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  cloud->reserve(points.size());
  for (const Point* p : points) cloud->push_back({p->x, p->y, p->z});
  pcl::KdTreeFLANN<pcl::PointXYZ> tree(false);
  tree.setInputCloud(cloud);
  parallel_chunks(candidates->rows, 8, [&](std::size_t begin, std::size_t end) {
    pcl::Indices index(1);
    std::vector<float> distance2(1);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < candidates->cols; ++x) {
        if (!beside(y, x)) continue;
        const float d = view_.depth(y, x), apart = spacing(d);
        const Eigen::Vector3f p =
            (view_.world_from_cam * view_.intrinsics.lift(x, y, d)).cast<float>();
        tree.nearestKSearch({p.x(), p.y(), p.z()}, 1, index, distance2);
        if (distance2[0] < apart * apart) (*candidates)(y, x) = 0;
      }
    }
  });
}

/// Greedy, row by row: a candidate that stays clears those after it within the spacing.
void ViewMatch::thin(Mask* candidates) const {
  for (int y = 0; y < candidates->rows; ++y) {
    for (int x = 0; x < candidates->cols; ++x) {
      if (!(*candidates)(y, x)) continue;
      const float d = view_.depth(y, x), apart = spacing(d);
      const Eigen::Vector3d here = view_.intrinsics.lift(x, y, d);
      const int pixels =
          static_cast<int>(std::min(kMostReach, std::ceil(apart / (footprint_per_metre_ * d))));
      for (int y2 = y; y2 <= std::min(y + pixels, candidates->rows - 1); ++y2) {
        const int first = y2 == y ? x + 1 : std::max(0, x - pixels);
        for (int x2 = first; x2 <= std::min(x + pixels, candidates->cols - 1); ++x2) {
          if (!(*candidates)(y2, x2)) continue;
          const Eigen::Vector3d there = view_.intrinsics.lift(x2, y2, view_.depth(y2, x2));
          if ((there - here).squaredNorm() < apart * apart) (*candidates)(y2, x2) = 0;
        }
      }
    }
  }
}

}  // namespace ps
