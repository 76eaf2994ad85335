// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: the points of a SceneCloud, with what views said about them.
#pragma once

#include <cstdint>
#include <vector>

#include "libps/geometry/camera.h"
#include "libps/geometry/point.h"

namespace ps {

/// What views have said about one point.
struct Evidence {
  float weight = 0;                ///< sum of the weights of the views averaged into it
  float r = 0, g = 0, b = 0;       ///< averaged colour in [0,1]
  std::uint16_t seen = 1;          ///< views that saw a surface where it is
  std::uint16_t seen_through = 0;  ///< views that saw a surface well behind it
};

/// @brief Points in the order they came, in chunks with bounding boxes. Views add points that are
/// near each other, so the chunks that a camera can see are found without touching the others.
class CloudStore {
 public:
  static constexpr std::size_t kChunk = 1024;

  std::size_t size() const { return points_.size(); }
  std::size_t chunks() const { return boxes_.size(); }
  Point& point(std::size_t i) { return points_[i]; }
  const Point& point(std::size_t i) const { return points_[i]; }
  Evidence& evidence(std::size_t i) { return evidence_[i]; }
  const Evidence& evidence(std::size_t i) const { return evidence_[i]; }
  bool alive(std::size_t i) const { return points_[i].footprint > 0; }
  void remove(std::size_t i) { points_[i].footprint = 0; }

  void add(const Point& point, const Evidence& evidence);

  /// @brief Keeps a moved point inside its chunk's box. Safe for points of different chunks at
  /// once.
  void moved(std::size_t i);

  /// @brief Drops points that are gone; the others keep their order.
  void compact();

  /// @return chunks that may hold points within `margin` pixels of the camera's image and not
  /// farther than `farthest` metres along its axis
  std::vector<std::uint32_t> chunks_in_view(const Intrinsics& intrinsics,
                                            const Pose& world_from_cam, double margin,
                                            double farthest) const;

 private:
  using Box = Eigen::AlignedBox3f;

  Cloud::VectorType points_;
  std::vector<Evidence> evidence_;
  std::vector<Box> boxes_;
};

}  // namespace ps
