// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: the points of a SceneCloud, with what views said about them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
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
  std::uint32_t number = 0;        ///< points that were added before it
};

/// @brief Points that are near each other in space; a point that is gone has no footprint.
struct CloudCell {
  Cloud::VectorType points;
  std::vector<Evidence> evidence;
  Eigen::AlignedBox3f box;
};

/// @brief Points in cells of space, so that a camera looks at those that it can see and no others.
/// A cell is about 64 footprints wide, whatever the scale of the scene.
class CloudStore {
 public:
  static bool alive(const Point& point) { return point.footprint > 0; }

  void add(const Point& point, Evidence evidence);

  std::vector<CloudCell>& cells() { return cells_; }
  const std::vector<CloudCell>& cells() const { return cells_; }

  /// @return how many points were ever added; numbers are below
  std::size_t numbers() const { return numbers_; }

  /// @return cells that may hold points within `margin` pixels of the camera's image and not
  /// farther than `farthest` metres along its axis
  std::vector<std::uint32_t> cells_in_view(const Intrinsics& intrinsics, const Pose& world_from_cam,
                                           double margin, double farthest) const;

 private:
  using Key = std::array<std::int32_t, 4>;  ///< exponent of the width, and the three places

  std::vector<CloudCell> cells_;
  std::map<Key, std::uint32_t> places_;
  Key last_key_ = {};
  std::uint32_t last_cell_ = UINT32_MAX;
  std::uint32_t numbers_ = 0;
};

}  // namespace ps
