// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: holds one view against the cloud.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "libps/geometry/cloud_store.h"
#include "libps/geometry/scene_cloud.h"

namespace ps {

/// What a view's word counts for a point's place: the inverse square of its footprint, since a
/// camera's error grows with the footprint. Metres.
inline float view_weight(float footprint) { return 1 / (footprint * footprint); }

// std::floor and std::ceil are calls on machines without SSE 4.1, and these are the hottest lines.
inline int floor_of(float x) {
  const int i = static_cast<int>(x);
  return i - static_cast<int>(x < static_cast<float>(i));
}
inline int ceil_of(float x) {
  const int i = static_cast<int>(x);
  return i + static_cast<int>(x > static_cast<float>(i));
}
inline int nearest_pixel(float u) { return floor_of(u + 0.5f); }

/// @brief Draws the cloud into a view and sorts pixels and points out: which pixels the cloud
/// explains, which points the view supports, sees better, or sees through.
class ViewMatch {
 public:
  /// Averages the view into the points it supports, counts what it sees through, removes the points
  /// whose surface it sees better, and draws the others. The arguments must outlive this.
  ViewMatch(CloudStore& store, const View& view, const Mask& usable, Origin origin,
            const SceneCloudOptions& options);

  /// @return how many points were removed
  std::size_t removed() const { return removed_; }

  /// @return usable pixels that no point left in the cloud explains
  Mask unexplained() const;

  /// @brief Clears candidates that have a point of the cloud, or an earlier candidate, nearer than
  /// the spacing (KD-tree of the points around candidates).
  void drop_near_neighbours(Mask* candidates) const;

 private:
  /// What the view says at a pixel; beside the image, depth is 0.
  struct Pixel {
    float nearest;            ///< smallest usable depth within reach; huge where there is none
    float farthest;           ///< greatest usable depth within reach; 0 where there is none
    float depth;              ///< 0 where not usable
    std::uint32_t explained;  ///< 1 where a point that stays explains the pixel
  };
  /// A point of the cloud that may be too near to a pixel that it does not explain.
  struct Seen {
    const Point* point;
    float u, v, z;
  };

  void fill_pixels();
  Pixel& pixel(int x, int y) { return pixels_[(y + kMargin) * stride_ + x + kMargin]; }
  const Pixel& pixel(int x, int y) const { return pixels_[(y + kMargin) * stride_ + x + kMargin]; }
  void fill_blocks();
  bool hidden(const Eigen::AlignedBox3f& box) const;
  void match_cell(CloudCell* cell, std::vector<Seen>* seen);
  void match_point(CloudCell* cell, std::size_t i, float u, float v, float z,
                   std::vector<Seen>* seen);
  bool support(CloudCell* cell, std::size_t i, float u, float v, int x, int y, float* z);
  float average(CloudCell* cell, std::size_t i, float z, float depth, const cv::Vec3f& color);
  /// What was observed is never changed by what is invented.
  bool may_speak_of(const Point& point) const {
    return origin_ == Origin::observed || static_cast<Origin>(point.origin) == Origin::outpainted;
  }
  float depth_at(float u, float v, float nearest) const;
  void draw(float u, float v, float z, float half);
  std::vector<const Point*> points_beside(const Mask& candidates, Mask* beside) const;
  bool beside(const Seen& seen, const Mask& candidates, Mask* beside) const;
  void drop_near_points(const std::vector<const Point*>& points, const Mask& beside,
                        Mask* candidates) const;
  void thin(Mask* candidates) const;
  float spacing(float depth) const {
    return std::max(spacing_footprints_ * footprint_per_metre_ * depth, spacing_);
  }

  static constexpr float kMostReach = 24;  ///< pixels that a spacing is looked for over
  static constexpr int kMargin = 2;  ///< pixels around the image in which points are looked at

  CloudStore& store_;
  const View& view_;
  const Mask& usable_;
  const Origin origin_;
  const SceneCloudOptions& options_;
  const float footprint_per_metre_;
  const float spacing_footprints_;
  const float spacing_;
  const float tolerance_per_metre_;
  const Eigen::Isometry3f cam_from_world_;
  int reach_ = 1;       ///< pixels that the spacing spans, at most
  float farthest_ = 0;  ///< greatest usable depth
  int stride_;          ///< pixels in a row, margins included
  std::vector<Pixel> pixels_;
  Depth blocks_;                         ///< greatest usable depth of blocks of pixels
  std::vector<std::vector<Seen>> seen_;  ///< by cell in view
  std::atomic<std::size_t> removed_{0};
};

}  // namespace ps
