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

constexpr int kMostPixelsAcross = 16;  ///< that one point is drawn over
constexpr float kMostReach = 24;       ///< pixels that a spacing is looked for over

// std::floor and std::ceil are calls on machines without SSE 4.1, and these are the hottest lines.
int floor_of(float x) {
  const int i = static_cast<int>(x);
  return i - static_cast<int>(x < static_cast<float>(i));
}
int ceil_of(float x) {
  const int i = static_cast<int>(x);
  return i + static_cast<int>(x > static_cast<float>(i));
}
int nearest_pixel(float u) { return floor_of(u + 0.5f); }

}  // namespace

ViewMatch::ViewMatch(CloudStore& store, const View& view, const Mask& usable, Origin origin,
                     const SceneCloudOptions& options)
    : store_(store),
      view_(view),
      usable_(usable),
      origin_(origin),
      options_(options),
      footprint_per_metre_(static_cast<float>(view.intrinsics.footprint_per_metre())),
      spacing_footprints_(static_cast<float>(options.spacing_footprints)),
      spacing_(static_cast<float>(options.spacing)),
      tolerance_per_metre_(
          static_cast<float>(options.tolerance_relative +
                             options.tolerance_footprints * view.intrinsics.footprint_per_metre())),
      cam_from_world_(view.world_from_cam.inverse().cast<float>()),
      stride_(view.depth.cols + 2 * kMargin),
      pixels_(static_cast<std::size_t>(stride_) * (view.depth.rows + 2 * kMargin)) {
  fill_pixels();
  const auto chunks = store_.chunks_in_view(view.intrinsics, view.world_from_cam, kMargin,
                                            farthest_ * (1 + tolerance_per_metre_));
  seen_.resize(chunks.size());
  parallel_for(chunks.size(), [&](std::size_t c) { match_chunk(chunks[c], &seen_[c]); });
}

void ViewMatch::fill_pixels() {
  constexpr float kHuge = std::numeric_limits<float>::max();
  const cv::Size size(stride_, view_.depth.rows + 2 * kMargin);
  Depth high(size, 0.f), low(size, kHuge);
  const cv::Rect image(kMargin, kMargin, view_.depth.cols, view_.depth.rows);
  view_.depth.copyTo(high(image), usable_);
  view_.depth.copyTo(low(image), usable_);
  double least = 0, most = 0;
  cv::minMaxLoc(low, &least);
  cv::minMaxLoc(high, nullptr, &most);
  farthest_ = static_cast<float>(most);
  if (most > 0) {
    const auto nearest = static_cast<float>(least);
    const float widest = spacing(nearest) / (footprint_per_metre_ * nearest);
    // A little less, so that rounding does not make two pixels of one.
    reach_ = std::max(1, static_cast<int>(std::ceil(std::min(widest, kMostReach) - 1e-3f)));
  }
  const cv::Mat1b window(2 * reach_ + 1, 2 * reach_ + 1, 1);
  Depth nearest_around, farthest_around;
  parallel_for(2, [&](std::size_t i) {
    i == 0 ? cv::erode(low, nearest_around, window) : cv::dilate(high, farthest_around, window);
  });
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    pixels_[i] = {nearest_around(static_cast<int>(i)), farthest_around(static_cast<int>(i)),
                  high(static_cast<int>(i)), 0};
  }
}

void ViewMatch::match_chunk(std::uint32_t chunk, std::vector<Seen>* seen) {
  const Intrinsics& k = view_.intrinsics;
  const auto fx = static_cast<float>(k.fx), fy = static_cast<float>(k.fy);
  const auto cx = static_cast<float>(k.cx), cy = static_cast<float>(k.cy);
  // One pixel inside the margin, so that rounding stays inside too.
  const auto right = static_cast<float>(k.width - 2 + kMargin);
  const auto bottom = static_cast<float>(k.height - 2 + kMargin);
  const Eigen::Matrix3f rotation = cam_from_world_.linear();
  const Eigen::Vector3f translation = cam_from_world_.translation();
  const auto begin = static_cast<std::uint32_t>(chunk * CloudStore::kChunk);
  const auto end =
      static_cast<std::uint32_t>(std::min<std::size_t>(begin + CloudStore::kChunk, store_.size()));
  for (std::uint32_t i = begin; i < end; ++i) {
    __builtin_prefetch(&store_.point(i) + 32);
    const Eigen::Vector3f p = rotation * store_.point(i).getVector3fMap() + translation;
    const float per_metre = 1 / p.z();
    const float u = fx * p.x() * per_metre + cx, v = fy * p.y() * per_metre + cy;
    const bool inside = p.z() > 1e-3f && u > 1 - kMargin && v > 1 - kMargin && u < right &&
                        v < bottom && store_.alive(i);
    if (inside) match_point(i, u, v, p.z(), seen);
  }
}

void ViewMatch::match_point(std::uint32_t index, float u, float v, float z,
                            std::vector<Seen>* seen) {
  const int x = nearest_pixel(u), y = nearest_pixel(v);
  const Pixel& here = pixel(x, y);
  if (z > here.farthest * (1 + tolerance_per_metre_) + spacing(here.farthest)) return;
  if (z < here.nearest * (1 - tolerance_per_metre_)) {
    Evidence& evidence = store_.evidence(index);
    if (here.depth > 0 && evidence.seen_through < UINT16_MAX) ++evidence.seen_through;
    if (z < here.nearest - spacing(here.nearest)) return;
  }
  if (support(index, u, v, x, y, &z)) {
    store_.remove(index);
    ++removed_;
    return;
  }
  const float own_footprint = store_.point(index).footprint, footprint = footprint_per_metre_ * z;
  const float covers = std::max(own_footprint * spacing_footprints_, spacing_);
  draw(u, v, z, std::clamp(covers / footprint, 0.5f, 0.5f * kMostPixelsAcross));
  // A point that covers as much as the spacing has explained all that it may be too near to.
  const bool explains_all = covers > 1.01f * spacing(z) &&
                            covers < 0.5f * kMostPixelsAcross * footprint &&
                            spacing(z) < tolerance_per_metre_ * z;
  if (explains_all) return;
  if (seen->capacity() == 0) seen->reserve(CloudStore::kChunk);
  seen->push_back({index, u, v, z});
}

/// Lets the view speak for the point; returns whether its own pixels shall replace it.
bool ViewMatch::support(std::uint32_t index, float u, float v, int x, int y, float* z) {
  const float d = pixel(x, y).depth;
  if (d <= 0 || std::fabs(*z - d) > tolerance_per_metre_ * d) return false;
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
  if (between > 0) *z = average(index, *z, between, view_.color(y, x));
  return false;
}

/// Moves the point along the view's ray to the weighted mean of what views say; returns its new z.
float ViewMatch::average(std::uint32_t index, float z, float depth, const cv::Vec3f& color) {
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
  return scale * z;
}

/// Bilinear in 1/z, which is linear over a plane's image, between four pixels of one surface; 0
/// where there are no such four.
float ViewMatch::depth_at(float u, float v, float nearest) const {
  const int x = floor_of(u), y = floor_of(v);
  const float a = u - static_cast<float>(x), b = v - static_cast<float>(y);
  const float tolerance = tolerance_per_metre_ * nearest;
  float inverse = 0;
  for (int i = 0; i < 4; ++i) {
    const int dx = i % 2, dy = i / 2;
    const float d = pixel(x + dx, y + dy).depth;  // 0 beside the image and where not usable
    if (std::fabs(d - nearest) > tolerance || d <= 0) return 0;
    inverse += (dx ? a : 1 - a) * (dy ? b : 1 - b) / d;
  }
  return 1 / inverse;
}

/// Marks the pixels nearer than `half` along either axis whose depth agrees.
void ViewMatch::draw(float u, float v, float z, float half) {
  const int x0 = std::max(0, ceil_of(u - half));
  const int y0 = std::max(0, ceil_of(v - half));
  const int x1 = std::min(usable_.cols - 1, floor_of(u + half));
  const int y1 = std::min(usable_.rows - 1, floor_of(v + half));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      Pixel& there = pixel(x, y);
      if (std::fabs(z - there.depth) <= tolerance_per_metre_ * there.depth) {
        // Several threads may say the same of one pixel.
        __atomic_store_n(&there.explained, 1u, __ATOMIC_RELAXED);
      }
    }
  }
}

Mask ViewMatch::unexplained() const {
  Mask result(usable_.size());
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      const Pixel& here = pixel(x, y);
      result(y, x) = here.depth > 0 && here.explained == 0;
    }
  }
  return result;
}

void ViewMatch::drop_near_neighbours(Mask* candidates) const {
  Mask beside(candidates->size(), std::uint8_t{0});
  const std::vector<std::uint32_t> points = points_beside(*candidates, &beside);
  if (!points.empty()) drop_near_points(points, beside, candidates);
  if (options_.spacing > 0 || options_.spacing_footprints > 1) thin(candidates);
}

/// The points that may be within the spacing of a candidate, and which candidates those are: the
/// rest need not go through the KD-tree.
std::vector<std::uint32_t> ViewMatch::points_beside(const Mask& candidates, Mask* beside) const {
  Mask near;
  cv::copyMakeBorder(candidates, near, kMargin, kMargin, kMargin, kMargin, cv::BORDER_CONSTANT);
  cv::dilate(near, near, cv::Mat1b(2 * reach_ + 3, 2 * reach_ + 3, 1));
  std::vector<std::vector<std::uint32_t>> found(seen_.size());
  parallel_for(seen_.size(), [&](std::size_t c) {
    for (const Seen& seen : seen_[c]) {
      const int x = nearest_pixel(seen.u) + kMargin, y = nearest_pixel(seen.v) + kMargin;
      if (near(y, x) && this->beside(seen, candidates, beside)) found[c].push_back(seen.index);
    }
  });
  std::vector<std::uint32_t> points;
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

void ViewMatch::drop_near_points(const std::vector<std::uint32_t>& points, const Mask& beside,
                                 Mask* candidates) const {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  cloud->reserve(points.size());
  for (const std::uint32_t index : points) {
    const Point& p = store_.point(index);
    cloud->push_back({p.x, p.y, p.z});
  }
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
