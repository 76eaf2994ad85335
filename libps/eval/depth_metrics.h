// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "libps/core/image.h"

namespace ps {

/// @brief Depth errors over the pixels where both depths are known (Eigen et al., NIPS 2014).
/// All but `pixels` are NaN when there is no such pixel.
struct DepthErrors {
  std::size_t pixels = 0;
  double abs_rel = 0;     ///< mean of |d - t| / t
  double median_rel = 0;  ///< median of |d - t| / t
  double rmse = 0;        ///< metres
  double mean_abs = 0;    ///< metres
  double delta[3] = {};   ///< share with max(d/t, t/d) below 1.25, 1.25^2, 1.25^3
};

/// @brief Compares a depth image (metres along z) with the true one. NaN, infinite, zero and
/// negative depths are unknown.
/// @param where  only where this is not 0; empty = everywhere. Throws ps::Error when sizes differ.
DepthErrors depth_errors(const Depth& depth, const Depth& truth, const Mask& where = {});

/// @return the depth times the ratio of the true median to its own, both over the pixels where both
/// are known (Zhou et al., SfMLearner, CVPR 2017): what is left is the error in proportions. The
/// depth itself where there is no such pixel. Throws ps::Error when sizes differ.
Depth median_scaled(const Depth& depth, const Depth& truth);

}  // namespace ps
