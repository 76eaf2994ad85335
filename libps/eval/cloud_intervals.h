// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/eval/statistics.h"
#include "libps/geometry/point.h"

namespace ps {

/// CloudScore with intervals.
struct CloudScoreInterval {
  double threshold = 0;  ///< metres
  Interval accuracy, completeness, f_score;
};

struct CloudIntervals {
  std::vector<CloudScoreInterval> scores;  ///< one for each threshold
  Interval chamfer;                        ///< metres
};

/// @brief cloud_scores() and chamfer_distance() with bootstrap intervals. Points near each other
/// are right or wrong together, so what is drawn is whole blocks of space, cubes of `block` metres
/// with all that both clouds have in them: `samples` counts blocks.
/// Throws ps::Error as cloud_scores() and bootstrap() do, and when `block` is not positive and
/// finite.
CloudIntervals cloud_intervals(const Cloud& cloud, const Cloud& truth,
                               const std::vector<double>& thresholds, double block = 0.5,
                               const BootstrapOptions& options = {});

}  // namespace ps
