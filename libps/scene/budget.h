// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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
  double pixels = 0.5;    ///< points nearer to each other than this may merge, whatever they show
  double spacing = 0.75;  ///< farthest that a point speaks for its like, in radii of the splats
  double tolerance =
      0.03;                ///< colours that differ by less are alike, once splats have blurred them
  std::size_t points = 0;  ///< finds the tolerance at which no more than so many stay; 0 = as given
  /// Finds the greatest tolerance at which pictures of the thinned cloud are this near to those of
  /// the whole: dB, in the worst of up to eight of the planned views, spread evenly over them,
  /// where the whole cloud hits. 0 = the tolerance as given. With `points` too, that is what is
  /// kept to.
  double psnr = 0;
  float radius = 4;          ///< of the splats, pixels
  bool drop_unseen = false;  ///< leave out what no planned view can see
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

/// @brief Merges the points of a cloud that planned views do not need apart.
///
/// A point that stays speaks for those around it: it keeps its place, view and origin, takes their
/// mean colour, and its footprint grows to the side of a square of all their area. It reaches as
/// far as the surface is flat to within `pixels` and, blurred as by splats, of one colour; to where
/// the surface ends or another begins it does not reach, so outlines, edges and texture keep their
/// points. Observed and outpainted points are never merged with each other. Two sides of a sheet
/// count as one surface if it is thinner than a pixel.
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
