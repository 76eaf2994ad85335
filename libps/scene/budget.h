// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "libps/geometry/camera.h"

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace ps {

struct Point;

/// A camera that a cloud will be looked at through.
struct PlannedView {
  Intrinsics intrinsics;
  Pose world_from_cam = Pose::Identity();
};

/// @brief How much of a cloud its planned views need. Pixels are those of the view that shows a
/// point finest.
struct BudgetOptions {
  double pixels = 0.5;      ///< points nearer to each other than this merge, whatever they show
  double spacing = 0.75;    ///< farthest that a point speaks for its like, in radii of the splats
  double tolerance = 0.01;  ///< colours, as splats show them, are one where they differ by no more
  /// Finds the tolerance at which no more points than this stay, nor much fewer; 0 = no target.
  std::size_t points = 0;
  /// Finds the greatest tolerance at which pictures of the thinned cloud are so near to those of
  /// the whole, dB: in the worst of up to eight of the planned views, taken evenly, over the pixels
  /// that the whole cloud hits; 0 = no target. Given both, `points` is kept to first.
  double psnr = 0;
  float radius = 4;          ///< of the widest splats, pixels (closed_splat.h)
  bool drop_unseen = false;  ///< leave out what no planned view can see
  /// Told what share is done, from 0 to 1 and never falling; of searches for a target that is an
  /// estimate. One call at a time, from any thread, very often. What it throws comes out
  /// of thinned().
  std::function<void(double done)> progress = {};
};

/// What became of a cloud; counts of points.
struct BudgetReport {
  std::size_t not_finite = 0;  ///< dropped
  std::size_t unseen = 0;      ///< outside of all views; kept, unless asked otherwise
  std::size_t merged = 0;      ///< into others
  std::size_t points = 0;      ///< left
  double tolerance = 0;        ///< that was used
  /// Within which points were merged whatever they show: BudgetOptions::pixels, but more where a
  /// target of points, or less where one of PSNR could not be met else; 0 when none were.
  double pixels = 0;
  double psnr = 0;  ///< that was reached; only if a target was given, and infinite if all is kept
};

/// @brief Thins an accumulated cloud (PixelSynth section 3.2) to what planned views need.
///
/// A point that stays speaks for others around it: it keeps its place, view and origin, takes the
/// mean of their colours, and its footprint grows until splats of it cover all their area, though
/// not beyond the end of its surface. It reaches as far as the surface is flat, to within `pixels`,
/// and of one colour; points where a surface ends, or that lie on none, speak for themselves. So
/// outlines, edges and texture stay.
/// Observed and outpainted points are never merged with each other, nor are two surfaces, unless
/// they are less than four times `pixels` apart or a target of very few points asks for it.
///
/// A point is seen by a view when it falls into its image, grown by the splats' radius; what is in
/// front of it is not asked. Points that are not finite are dropped, and when no view is planned
/// nothing else is done. Points stay in their order; bytes do not depend on the number of threads.
/// @param report  filled, if given
/// Throws ps::Error when a view or an option is unsound.
pcl::PointCloud<Point> thinned(const pcl::PointCloud<Point>& cloud,
                               const std::vector<PlannedView>& views,
                               const BudgetOptions& options = {}, BudgetReport* report = nullptr);

}  // namespace ps
