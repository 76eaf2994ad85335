// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/view_match.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr int kMargin = 2;             ///< pixels around the image in which points are looked at
constexpr int kMostPixelsAcross = 16;  ///< that one point is drawn over
constexpr float kMostReach = 24;       ///< pixels that a spacing is looked for over

int nearest_pixel(float u) { return static_cast<int>(std::floor(u + 0.5f)); }

}  // namespace

ViewMatch::ViewMatch(CloudStore& store, const View& view, const Mask& usable, Origin origin,
                     const SceneCloudOptions& options)
    : store_(store),
      view_(view),
      usable_(usable),
      origin_(origin),
      options_(options),
      footprint_per_metre_(static_cast<float>(view.intrinsics.footprint_per_metre())),
      tolerance_per_metre_(
          static_cast<float>(options.tolerance_relative +
                             options.tolerance_footprints * view.intrinsics.footprint_per_metre())),
      cam_from_world_(view.world_from_cam.inverse().cast<float>()),
      explained_(view.depth.size(), 0) {
  find_depths_around();
  const auto chunks = store_.chunks_in_view(view.intrinsics, view.world_from_cam, kMargin,
                                            farthest_ * (1 + tolerance_per_metre_));
  seen_.resize(chunks.size());
  parallel_for(chunks.size(), [&](std::size_t c) { match_chunk(chunks[c], &seen_[c]); });
}

void ViewMatch::find_depths_around() {
  const int m = kMargin;
  Depth low, high;
  view_.depth.copyTo(high, usable_);
  high.setTo(0, usable_ == 0);
  low = high.clone();
  low.setTo(std::numeric_limits<float>::max(), usable_ == 0);
  double least = 0, most = 0;
  cv::minMaxLoc(low, &least, nullptr, nullptr, nullptr);
  cv::minMaxLoc(high, nullptr, &most, nullptr, nullptr);
  farthest_ = static_cast<float>(most);
  const auto nearest = static_cast<float>(least);
  if (most > 0) {
    const float widest = spacing(nearest) / (footprint_per_metre_ * nearest);
    reach_ = static_cast<int>(std::ceil(std::min(widest, kMostReach)));
  }
  cv::copyMakeBorder(low, low, m, m, m, m, cv::BORDER_CONSTANT, least > 0 ? 3e38 : 0);
  cv::copyMakeBorder(high, high, m, m, m, m, cv::BORDER_CONSTANT, 0);
  const cv::Mat1b window(2 * reach_ + 1, 2 * reach_ + 1, 1);
  cv::erode(low, nearest_around_, window);
  cv::dilate(high, farthest_around_, window);
}

void ViewMatch::match_chunk(std::uint32_t chunk, std::vector<Seen>* seen) {
  const Intrinsics& k = view_.intrinsics;
  const auto fx = static_cast<float>(k.fx), fy = static_cast<float>(k.fy);
  const auto cx = static_cast<float>(k.cx), cy = static_cast<float>(k.cy);
  const Eigen::Matrix3f rotation = cam_from_world_.linear();
  const Eigen::Vector3f translation = cam_from_world_.translation();
  std::size_t removed = 0;
  const std::size_t begin = chunk * CloudStore::kChunk;
  const std::size_t end = std::min(begin + CloudStore::kChunk, store_.size());
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector3f p = rotation * store_.point(i).getVector3fMap() + translation;
    if (!store_.alive(i) || !(p.z() > 1e-3f)) continue;
    const float u = fx * p.x() / p.z() + cx, v = fy * p.y() / p.z() + cy;
    // One pixel inside the margin, so that rounding stays inside too.
    if (!(u > -kMargin && v > -kMargin && u < static_cast<float>(k.width - 1 + kMargin) &&
          v < static_cast<float>(k.height - 1 + kMargin))) {
      continue;
    }
    const int x = nearest_pixel(u), y = nearest_pixel(v);
    const float far = farthest_around_(y + kMargin, x + kMargin);
    if (p.z() > far * (1 + tolerance_per_metre_) + spacing(far)) continue;
    const float near = nearest_around_(y + kMargin, x + kMargin);
    if (p.z() < near * (1 - tolerance_per_metre_)) {
      Evidence& evidence = store_.evidence(i);
      const bool inside = x >= 0 && y >= 0 && x < k.width && y < k.height && usable_(y, x);
      if (inside && evidence.seen_through < UINT16_MAX) ++evidence.seen_through;
      if (p.z() < near - spacing(near)) continue;
    }
    const auto index = static_cast<std::uint32_t>(i);
    const Seen here = {index, p.z(), static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
    if (support(index, u, v, here)) {
      store_.remove(i);
      ++removed;
    } else {
      seen->push_back(here);
      draw(index, u, v, p.z());
    }
  }
  removed_ += removed;
}

/// Lets the view speak for or against the point; returns whether its own pixels shall replace it.
bool ViewMatch::support(std::uint32_t index, float u, float v, const Seen& seen) {
  const bool inside = seen.x >= 0 && seen.y >= 0 && seen.x < usable_.cols && seen.y < usable_.rows;
  if (!inside || !usable_(seen.y, seen.x)) return false;
  const float d = view_.depth(seen.y, seen.x);
  if (std::fabs(seen.z - d) > tolerance_per_metre_ * d) return false;
  Evidence& evidence = store_.evidence(index);
  if (evidence.seen < UINT16_MAX) ++evidence.seen;
  const Point& point = store_.point(index);
  const bool observed = origin_ == Origin::observed;
  const bool was_observed = point.origin == static_cast<std::uint8_t>(Origin::observed);
  if (was_observed && !observed)
    return false;  // what was seen is never changed by what is invented
  if (observed && !was_observed) return true;
  if (footprint_per_metre_ * d < options_.better_footprint * point.footprint) return true;
  const float between = options_.average ? depth_at(u, v, d) : 0;
  if (between > 0) average(index, seen.z, between, view_.color(seen.y, seen.x));
  return false;
}

/// Moves the point along the view's ray to the weighted mean of what views say.
void ViewMatch::average(std::uint32_t index, float z, float depth, const cv::Vec3f& color) {
  Point& point = store_.point(index);
  Evidence& evidence = store_.evidence(index);
  const float weight = view_weight(footprint_per_metre_ * depth);
  const float share = weight / (evidence.weight + weight);
  const Eigen::Vector3f centre = view_.world_from_cam.translation().cast<float>();
  const float scale = 1 + share * (depth - z) / z;
  point.getVector3fMap() = centre + scale * (point.getVector3fMap() - centre);
  store_.moved(index);
  evidence.r += share * (color[0] - evidence.r);
  evidence.g += share * (color[1] - evidence.g);
  evidence.b += share * (color[2] - evidence.b);
  evidence.weight += weight;
}

/// Bilinear in 1/z, which is linear over a plane's image, between four pixels of one surface; 0
/// where there are no such four.
float ViewMatch::depth_at(float u, float v, float nearest) const {
  const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  if (x < 0 || y < 0 || x + 1 >= usable_.cols || y + 1 >= usable_.rows) return 0;
  const float a = u - static_cast<float>(x), b = v - static_cast<float>(y);
  float inverse = 0;
  for (int i = 0; i < 4; ++i) {
    const int dx = i % 2, dy = i / 2;
    const float d = view_.depth(y + dy, x + dx);
    if (!usable_(y + dy, x + dx) || std::fabs(d - nearest) > tolerance_per_metre_ * nearest) {
      return 0;
    }
    inverse += (dx ? a : 1 - a) * (dy ? b : 1 - b) / d;
  }
  return 1 / inverse;
}

/// Marks the pixels that the point stands for and whose depth it agrees with.
void ViewMatch::draw(std::uint32_t index, float u, float v, float z) {
  const float covers =
      std::max(store_.point(index).footprint * static_cast<float>(options_.spacing_footprints),
               static_cast<float>(options_.spacing));
  const float half =
      std::clamp(covers / (footprint_per_metre_ * z), 0.5f, 0.5f * kMostPixelsAcross);
  const int x0 = std::max(0, static_cast<int>(std::ceil(u - half)));
  const int y0 = std::max(0, static_cast<int>(std::ceil(v - half)));
  const int x1 = std::min(usable_.cols - 1, static_cast<int>(std::floor(u + half)));
  const int y1 = std::min(usable_.rows - 1, static_cast<int>(std::floor(v + half)));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const float d = view_.depth(y, x);
      if (std::fabs(z - d) <= tolerance_per_metre_ * d) {
        // Several threads may say the same of one pixel.
        __atomic_store_n(&explained_(y, x), std::uint8_t{255}, __ATOMIC_RELAXED);
      }
    }
  }
}

float ViewMatch::spacing(float depth) const {
  return std::max(static_cast<float>(options_.spacing_footprints) * footprint_per_metre_ * depth,
                  static_cast<float>(options_.spacing));
}

void ViewMatch::drop_near_neighbours(Mask* candidates) const {
  const std::vector<std::uint32_t> around = points_around(*candidates);
  if (!around.empty()) drop_near_points(around, candidates);
  if (options_.spacing > 0 || options_.spacing_footprints > 1) thin(candidates);
}

std::vector<std::uint32_t> ViewMatch::points_around(const Mask& candidates) const {
  Mask near;
  cv::copyMakeBorder(candidates, near, kMargin, kMargin, kMargin, kMargin, cv::BORDER_CONSTANT);
  cv::dilate(near, near, cv::Mat1b(2 * reach_ + 3, 2 * reach_ + 3, 1));
  std::vector<std::uint32_t> around;
  for (const auto& chunk : seen_) {
    for (const Seen& seen : chunk) {
      if (near(seen.y + kMargin, seen.x + kMargin)) around.push_back(seen.index);
    }
  }
  return around;
}

void ViewMatch::drop_near_points(const std::vector<std::uint32_t>& around, Mask* candidates) const {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>);
  points->reserve(around.size());
  for (const std::uint32_t index : around) {
    const Point& p = store_.point(index);
    points->push_back({p.x, p.y, p.z});
  }
  pcl::KdTreeFLANN<pcl::PointXYZ> tree(false);
  tree.setInputCloud(points);
  parallel_for(candidates->rows, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    pcl::Indices index(1);
    std::vector<float> distance2(1);
    for (int x = 0; x < candidates->cols; ++x) {
      if (!(*candidates)(y, x)) continue;
      const float d = view_.depth(y, x), apart = spacing(d);
      const Eigen::Vector3f p =
          (view_.world_from_cam * view_.intrinsics.lift(x, y, d)).cast<float>();
      tree.nearestKSearch({p.x(), p.y(), p.z()}, 1, index, distance2);
      if (distance2[0] < apart * apart) (*candidates)(y, x) = 0;
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
