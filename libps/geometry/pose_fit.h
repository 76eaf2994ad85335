// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: a camera's pose from points whose depths may be wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libps/geometry/camera.h"

namespace ps {

/// A point that the first camera sees, and where the second sees it.
struct Sighting {
  Eigen::Vector3d point_in_first;   ///< metres; its direction is exact, its depth may not be
  Eigen::Vector2d pixel_in_second;  ///< pixels
  bool depth_known = true;          ///< else its depth is any, that of others, say
};

struct PoseFit {
  Pose second_from_first = Pose::Identity();
  double depth_error = 0;  ///< relative standard deviation of the known depths, as found
  /// Log likelihood of the sightings, over that of matches that lie anywhere in the photo.
  double log_likelihood = 0;
  std::vector<std::uint8_t> inlier;  ///< 1 for sightings that fit
  std::size_t inliers = 0;
  /// Standard deviations of the pose, as far as sightings err independently of each other.
  double rotation_sigma = 0;     ///< radians
  double translation_sigma = 0;  ///< metres
};

/// @brief Maximum likelihood of the pose and of the depths' error, from `start`.
///
/// A relative error s of a point's depth moves its projection along the epipolar line by s times a
/// vector g that vanishes with the baseline (the derivative of the projection by log depth). So a
/// true match's residual is normal with covariance pixel_sigma^2 I + depth_error^2 g g^T, and any
/// other's is even over the photo. Across the line pixels count in full (the epipolar constraint),
/// along it as much as depths prove to be right (the perspective-n-point problem): one estimate
/// serves true depths, guessed ones, and no baseline at all. Sightings without a depth count across
/// the line alone.
/// @param pixel_sigma  pixels of the second photo
/// @param depth_error  first guess, relative
PoseFit fit_pose(const std::vector<Sighting>& sightings, const Intrinsics& second_lens,
                 const Pose& start, double pixel_sigma, double depth_error);

/// @brief A start from the perspective-n-point problem: OpenCV's P3P with RANSAC.
/// @param tolerance  pixels
/// @return false when no pose was found
bool start_from_points(const std::vector<Sighting>& sightings, const Intrinsics& second_lens,
                       double tolerance, Pose* second_from_first);

/// @brief A start from the directions alone: OpenCV's five-point RANSAC for the essential matrix
/// (Nister, PAMI 2004); the baseline's length is the one that makes the median depth right.
/// @param tolerance  pixels from the epipolar line
/// @return false when no pose was found
bool start_from_directions(const std::vector<Sighting>& sightings, const Intrinsics& second_lens,
                           double tolerance, Pose* second_from_first);

}  // namespace ps
