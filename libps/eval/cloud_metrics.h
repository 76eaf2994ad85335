// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/geometry/point.h"
#include "libps/geometry/view.h"

namespace ps {

/// @brief How well a cloud matches a true cloud (Knapitsch et al., Tanks and Temples, 2017).
struct CloudScore {
  double threshold = 0;     ///< metres
  double accuracy = 0;      ///< share of the cloud's points nearer than this to a true point
  double completeness = 0;  ///< share of the true points nearer than this to a point of the cloud
  double f_score = 0;       ///< harmonic mean of the two; 0 when either cloud is empty
};

/// @return one score for each threshold (metres); distances are exact nearest-neighbour distances
///
/// Points that are not finite are left out of both clouds. With an empty cloud all shares are 0.
/// Throws ps::Error when a threshold is not positive and finite. Runs on all threads.
std::vector<CloudScore> cloud_scores(const Cloud& cloud, const Cloud& truth,
                                     const std::vector<double>& thresholds);

/// @brief Symmetric chamfer distance: the mean of the two mean nearest-neighbour distances, metres.
/// Points that are not finite are left out; NaN when either cloud is empty. The same bits for any
/// number of threads.
double chamfer_distance(const Cloud& a, const Cloud& b);

/// @return for each point of `from`, metres to the nearest point of `to`, exactly: NaN for a point
/// that is not finite, infinite when `to` has no finite point. Runs on all threads.
std::vector<double> nearest_distances(const Cloud& from, const Cloud& to);

/// @brief How much of what was invented contradicts what a camera saw.
/// @param seen  with depth (metres), lens and pose; colours are not looked at
/// @return the share of the points of this origin that stand before the surface that `seen` saw at
/// their pixel, by more than a hundredth of its depth; NaN when there are no such points
double share_in_front(const Cloud& cloud, Origin origin, const View& seen);

}  // namespace ps
