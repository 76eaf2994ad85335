// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "libps/geometry/lift.h"

namespace ps {

struct SceneCloudOptions {
  LiftOptions lift;
  /// Two depths along one ray are the same surface when they differ by less than
  /// `tolerance_relative` of the depth plus `tolerance_footprints` footprints.
  double tolerance_relative = 0.015;
  double tolerance_footprints = 3;
  /// A new point is dropped when an old one is nearer than this many of its own footprints.
  double spacing_footprints = 1;
  /// ... or nearer than this, metres: 0 keeps all that the sensor resolves. It is kept where it
  /// spans up to 24 pixels of a view, inside the view's image; beyond, points may be nearer to each
  /// other.
  double spacing = 0;
  /// A view whose footprint is below this share of a point's replaces the point by its own pixels.
  double better_footprint = 0.7;
  /// Move a point along the ray of each further view that sees it, by weight, so noise averages
  /// out.
  bool average = true;
};

/// What one view did to the cloud; counts of pixels and points.
struct AddReport {
  std::size_t lifted = 0;      ///< pixels with a usable depth
  std::size_t explained = 0;   ///< pixels the cloud already explained
  std::size_t duplicates = 0;  ///< pixels dropped because an old point is within the spacing
  std::size_t added = 0;       ///< points added
  std::size_t replaced = 0;    ///< points removed because this view sees their surface better

  AddReport& operator+=(const AddReport& other) {
    lifted += other.lifted;
    explained += other.explained;
    duplicates += other.duplicates;
    added += other.added;
    replaced += other.replaced;
    return *this;
  }
};

/// @brief One world: accumulates views into one cloud without duplicates (SPEC.md 1;
/// PixelSynth section 3.2; running averages after Keller et al., 3DV 2013).
///
/// A new view contributes only pixels that the cloud does not explain already: the cloud is drawn
/// into the view, depths are compared, and what is left is checked against a KD-tree of the nearby
/// points. World frame, metres. The bytes of the cloud do not depend on the number of threads.
class SceneCloud {
 public:
  explicit SceneCloud(const SceneCloudOptions& options = {});
  ~SceneCloud();
  SceneCloud(SceneCloud&&) noexcept;
  SceneCloud& operator=(SceneCloud&&) noexcept;

  /// @brief Adds a view. Throws ps::Error (nothing is changed then) when the view is unsound, or
  /// when its pixels are nearer to each other than floats can tell apart where it stands.
  /// @param pixels  empty: all liftable pixels; else only where it is not 0
  AddReport add(const View& view, std::uint16_t view_number, Origin origin = Origin::observed,
                const Mask& pixels = {});

  /// @brief Removes points that later views saw through at least as often as views supported them.
  /// @return how many went
  std::size_t remove_contradicted();

  /// @return the points that are alive, in the order in which they were added
  Cloud cloud() const;

  std::size_t size() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ps
