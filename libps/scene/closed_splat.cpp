// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/closed_splat.h"

#include <algorithm>
#include <opencv2/core.hpp>

namespace ps {

Splat closed_splat(const PointsView& points, const Intrinsics& intrinsics,
                   const Pose& world_from_cam, const SplatOptions& options, float widest) {
  Splat result = splat(points, intrinsics, world_from_cam, options);
  SplatOptions wider = options;
  wider.count_hits = false;
  while (wider.radius < widest && cv::countNonZero(result.hit == 0) > 0) {
    wider.radius = std::min(2 * wider.radius, widest);
    const Splat more = splat(points, intrinsics, world_from_cam, wider);
    const Mask fresh = more.hit & (result.hit == 0);
    more.color.copyTo(result.color, fresh);
    more.first_depth.copyTo(result.first_depth, fresh);
    more.expected_depth.copyTo(result.expected_depth, fresh);
    more.hit.copyTo(result.hit, fresh);
    result.missing = more.missing;
  }
  return result;
}

}  // namespace ps
