// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "libps/geometry/view.h"

namespace ps {

struct SecondPoseOptions {
  std::size_t least_inliers = 25;  ///< matches that must fit one pose; unrelated photos have 7
  double least_cover = 0.03;       ///< share of each photo that the inliers must be spread over
};

/// @brief Where the second photo was taken, and how its depth goes with the first's.
struct SecondPose {
  Pose world_from_cam = Pose::Identity();  ///< in the first view's world
  std::size_t matches = 0;                 ///< places found in both photos
  std::size_t inliers = 0;                 ///< those that fit the pose
  /// Pixels of the second photo, median of the inliers at which the first has a depth. A wrong
  /// depth adds to it.
  double reprojection_error = 0;
  /// Relative standard deviation of the first's depths from those that the pose asks for. From 0.01
  /// (measured) to 0.4, where the pose hardly trusts them: then check it.
  double depth_error = 0;
  double depth_scale = 1;  ///< multiply the second's depth by this; 1 where none was given
  /// Median absolute deviation of the log ratio of the two depths; NaN where none was given.
  double depth_spread = 0;
};

/// @brief Finds the pose of a second photo of a place, in metres of the first view's world.
///
/// SIFT matches (Lowe, IJCV 2004) are lifted by the first's depth. Two starts, by P3P and by the
/// essential matrix, each with RANSAC, lead to a fit that trusts the depths as far as they prove
/// right (pose_fit.h): they may be a network's guess, smoothly wrong by 10 or 20 %. Matches without
/// a depth count by their direction. depth_scale is the median ratio of the depths, at the inliers
/// and then over all that both see.
/// @param first         its depth need not be known everywhere
/// @param second_depth  of the second photo's size, of any scale, 0 = unknown; or empty
/// The same bytes for any number of threads. Throws ps::Error for unsound input, and when the
/// photos do not tell: too few inliers, all of them in one spot, a pose that they hardly determine
/// or that is absurdly far away, or depths that never meet.
SecondPose find_second_pose(const View& first, const Image& second, const Intrinsics& second_lens,
                            const Depth& second_depth = {}, const SecondPoseOptions& options = {});

/// @brief By what to multiply the second view's depths so that they agree with the first's: the
/// median ratio over all that both see; 1 where they see nothing in common.
double depth_scale_between(const View& first, const View& second);

}  // namespace ps
