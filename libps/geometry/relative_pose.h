// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "libps/geometry/view.h"

namespace ps {

struct SecondPoseOptions {
  std::size_t least_inliers = 25;  ///< matches that must fit one pose
  double least_cover = 0.03;       ///< share of each photo that the inliers must be spread over
};

/// @brief Where the second photo was taken, and how its depth goes with the first's.
struct SecondPose {
  Pose world_from_cam = Pose::Identity();  ///< in the first view's world
  std::size_t matches = 0;                 ///< places in both photos at which the first has a depth
  std::size_t inliers = 0;                 ///< those that fit the pose
  double reprojection_error = 0;           ///< pixels of the second photo, median of the inliers
  /// Relative error of the first's depths that the pose found along the inliers' rays.
  double depth_error = 0;
  double depth_scale = 1;   ///< multiply the second's depth by this; 1 without one
  double depth_spread = 0;  ///< median absolute deviation of the log ratio; NaN without one
};

/// @brief Finds the pose of a second photo of a place, in metres of the first view's world.
///
/// SIFT matches are lifted by the first's depth; P3P with RANSAC, or the essential matrix where
/// that finds little, starts a robust fit that holds depths only as far as they are to be trusted
/// (pose_fit.h), as they may be a network's guess, smoothly wrong by 10 or 20 %. Directions suffer
/// little from that; the baseline's length errs as the depths do. Then depth_scale is the median
/// ratio of the depths, at the inliers and then over all that both see.
/// @param first        not changed; its depth need not be known everywhere
/// @param second_depth  of the second photo's size, any unit, or empty
/// The same bytes for any number of threads. Throws ps::Error for unsound input, and when the
/// photos do not tell: too few inliers, all of them in one spot, or a pose that they hardly
/// determine or that is absurdly far away.
SecondPose find_second_pose(const View& first, const Image& second, const Intrinsics& second_lens,
                            const Depth& second_depth = {}, const SecondPoseOptions& options = {});

/// @brief By what to multiply the second view's depths so that they agree with the first's: the
/// median ratio over all that both see; 1 where they see nothing in common.
double depth_scale_between(const View& first, const View& second);

}  // namespace ps
