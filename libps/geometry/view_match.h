// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: holds one view against the cloud.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "libps/geometry/cloud_store.h"
#include "libps/geometry/scene_cloud.h"

namespace ps {

/// What a view's word counts for a point's place: the inverse square of its footprint, since a
/// camera's error grows with the footprint. Metres.
inline float view_weight(float footprint) { return 1 / (footprint * footprint); }

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
  Mask unexplained() const { return usable_ & ~explained_; }

  /// @brief Clears candidates that have a point of the cloud, or an earlier candidate, nearer than
  /// the spacing (KD-tree of the points around candidates).
  void drop_near_neighbours(Mask* candidates) const;

 private:
  /// A point of the cloud beside a surface of the view.
  struct Seen {
    std::uint32_t index;
    float z;
    std::int16_t x, y;  ///< nearest pixel
  };

  void find_depths_around();
  void match_chunk(std::uint32_t chunk, std::vector<Seen>* seen);
  bool support(std::uint32_t index, float u, float v, const Seen& seen);
  void average(std::uint32_t index, float z, float depth, const cv::Vec3f& color);
  float depth_at(float u, float v, float nearest) const;
  void draw(std::uint32_t index, float u, float v, float z);
  std::vector<std::uint32_t> points_around(const Mask& candidates) const;
  void drop_near_points(const std::vector<std::uint32_t>& around, Mask* candidates) const;
  void thin(Mask* candidates) const;
  float spacing(float depth) const;

  CloudStore& store_;
  const View& view_;
  const Mask& usable_;
  const Origin origin_;
  const SceneCloudOptions& options_;
  const float footprint_per_metre_;
  const float tolerance_per_metre_;
  const Eigen::Isometry3f cam_from_world_;
  int reach_ = 1;                        ///< pixels that the spacing spans, at most
  Depth nearest_around_;                 ///< smallest usable depth within the reach; with a margin
  Depth farthest_around_;                ///< greatest; 0 = none
  float farthest_ = 0;                   ///< greatest usable depth
  Mask explained_;                       ///< 255 where a point that stays explains the pixel
  std::vector<std::vector<Seen>> seen_;  ///< by chunk in view
  std::atomic<std::size_t> removed_{0};
};

}  // namespace ps
