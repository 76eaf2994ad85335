// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/view_match.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr int kBlock = 16;             ///< pixels across that a cell is first held against
constexpr int kMostPixelsAcross = 16;  ///< that one point is drawn over

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
  fill_blocks();
  const auto cells = store_.cells_in_view(view.intrinsics, view.world_from_cam, kMargin,
                                          farthest_ * (1 + tolerance_per_metre_));
  seen_.resize(cells.size());
  parallel_for(cells.size(), [&](std::size_t c) {
    CloudCell& cell = store_.cells()[cells[c]];
    if (!hidden(cell.box)) match_cell(&cell, &seen_[c]);
  });
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
  parallel_chunks(size.height, kBlock, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      Pixel* row = &pixels_[static_cast<std::size_t>(y) * stride_];
      for (int x = 0; x < stride_; ++x) {
        row[x] = {nearest_around(y, x), farthest_around(y, x), high(y, x), 0};
      }
    }
  });
}

void ViewMatch::fill_blocks() {
  const int height = static_cast<int>(pixels_.size()) / stride_;
  blocks_ = Depth((height - 1) / kBlock + 1, (stride_ - 1) / kBlock + 1, 0.f);
  parallel_for(blocks_.rows, [&](std::size_t row) {
    const int first = static_cast<int>(row) * kBlock;
    for (int y = first; y < std::min(first + kBlock, height); ++y) {
      for (int x = 0; x < stride_; ++x) {
        float& block = blocks_(static_cast<int>(row), x / kBlock);
        block = std::max(block, pixels_[static_cast<std::size_t>(y) * stride_ + x].farthest);
      }
    }
  });
}

/// Does all of the box lie behind what the view sees there? Such points get no word from it.
bool ViewMatch::hidden(const Eigen::AlignedBox3f& box) const {
  const Intrinsics& k = view_.intrinsics;
  Eigen::AlignedBox2f image;
  float nearest = std::numeric_limits<float>::max();
  for (int i = 0; i < 8; ++i) {
    const auto corner = static_cast<Eigen::AlignedBox3f::CornerType>(i);
    const Eigen::Vector3f p = cam_from_world_ * box.corner(corner);
    if (p.z() < 1e-3f) return false;
    nearest = std::min(nearest, p.z());
    image.extend(Eigen::Vector2f(p.x() / p.z(), p.y() / p.z()));
  }
  const auto block_of = [](double pixel, int most) {
    return static_cast<int>(std::clamp(pixel + kMargin, 0.0, most - 1.0)) / kBlock;
  };
  const int width = stride_, height = static_cast<int>(pixels_.size()) / stride_;
  const int x0 = block_of(k.fx * image.min().x() + k.cx - 1, width);
  const int x1 = block_of(k.fx * image.max().x() + k.cx + 1, width);
  const int y0 = block_of(k.fy * image.min().y() + k.cy - 1, height);
  const int y1 = block_of(k.fy * image.max().y() + k.cy + 1, height);
  float farthest = 0;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) farthest = std::max(farthest, blocks_(y, x));
  }
  return nearest * 0.9999f > farthest * (1 + tolerance_per_metre_) + spacing(farthest);
}

void ViewMatch::match_cell(CloudCell* cell, std::vector<Seen>* seen) {
  const Intrinsics& k = view_.intrinsics;
  const auto fx = static_cast<float>(k.fx), fy = static_cast<float>(k.fy);
  const auto cx = static_cast<float>(k.cx), cy = static_cast<float>(k.cy);
  // One pixel inside the margin, so that rounding stays inside too.
  const auto right = static_cast<float>(k.width - 2 + kMargin);
  const auto bottom = static_cast<float>(k.height - 2 + kMargin);
  const Eigen::Matrix3f rotation = cam_from_world_.linear();
  const Eigen::Vector3f translation = cam_from_world_.translation();
  for (std::size_t i = 0; i < cell->points.size(); ++i) {
    const Point& point = cell->points[i];
    const Eigen::Vector3f p = rotation * point.getVector3fMap() + translation;
    const float per_metre = 1 / p.z();
    const float u = fx * p.x() * per_metre + cx, v = fy * p.y() * per_metre + cy;
    const bool inside = p.z() > 1e-3f && u > 1 - kMargin && v > 1 - kMargin && u < right &&
                        v < bottom && CloudStore::alive(point);
    if (inside) match_point(cell, i, u, v, p.z(), seen);
  }
}

void ViewMatch::match_point(CloudCell* cell, std::size_t i, float u, float v, float z,
                            std::vector<Seen>* seen) {
  const int x = nearest_pixel(u), y = nearest_pixel(v);
  const Pixel& here = pixel(x, y);
  if (z > here.farthest * (1 + tolerance_per_metre_) + spacing(here.farthest)) return;
  if (z < here.nearest * (1 - tolerance_per_metre_)) {
    Evidence& evidence = cell->evidence[i];
    const bool heard = here.depth > 0 && may_speak_of(cell->points[i]);
    if (heard && evidence.seen_through < UINT16_MAX) ++evidence.seen_through;
    if (z < here.nearest - spacing(here.nearest)) return;
  }
  Point& point = cell->points[i];
  if (support(cell, i, u, v, x, y, &z)) {
    point.footprint = 0;
    ++removed_;
    return;
  }
  const float footprint = footprint_per_metre_ * z;
  const float covers = std::max(point.footprint * spacing_footprints_, spacing_);
  draw(u, v, z, std::clamp(covers / footprint, 0.5f, 0.5f * kMostPixelsAcross));
  // A point that covers as much as the spacing has explained all that it may be too near to.
  const bool explains_all = covers > 1.01f * spacing(z) &&
                            covers < 0.5f * kMostPixelsAcross * footprint &&
                            spacing(z) < tolerance_per_metre_ * z;
  if (explains_all) return;
  seen->emplace_back();
  Seen& last =
      seen->back();  // field by field: a whole one goes through memory in two widths, and stalls
  last.point = &point;
  last.u = u;
  last.v = v;
  last.z = z;
}

/// Lets the view speak for the point; returns whether its own pixels shall replace it.
bool ViewMatch::support(CloudCell* cell, std::size_t i, float u, float v, int x, int y, float* z) {
  const float d = pixel(x, y).depth;
  if (d <= 0 || std::fabs(*z - d) > tolerance_per_metre_ * d) return false;
  const Point& point = cell->points[i];
  if (!may_speak_of(point)) return false;
  Evidence& evidence = cell->evidence[i];
  if (evidence.seen < UINT16_MAX) ++evidence.seen;
  if (static_cast<Origin>(point.origin) != origin_) return true;  // observed at last
  if (footprint_per_metre_ * d < options_.better_footprint * point.footprint) return true;
  const float between = options_.average ? depth_at(u, v, d) : 0;
  if (between > 0) *z = average(cell, i, *z, between, view_.color(y, x));
  return false;
}

/// Moves the point along the view's ray to the weighted mean of what views say; returns its new z.
float ViewMatch::average(CloudCell* cell, std::size_t i, float z, float depth,
                         const cv::Vec3f& color) {
  Point& point = cell->points[i];
  Evidence& evidence = cell->evidence[i];
  const float weight = view_weight(footprint_per_metre_ * depth);
  const float share = weight / (evidence.weight + weight);
  const Eigen::Vector3f centre = view_.world_from_cam.translation().cast<float>();
  const float scale = 1 + share * (depth - z) / z;
  point.getVector3fMap() = centre + scale * (point.getVector3fMap() - centre);
  cell->box.extend(point.getVector3fMap());
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
  parallel_chunks(result.rows, kBlock, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < result.cols; ++x) {
        const Pixel& here = pixel(x, y);
        result(y, x) =
            static_cast<std::uint8_t>((here.depth > 0) & static_cast<int>(here.explained == 0));
      }
    }
  });
  return result;
}

}  // namespace ps
