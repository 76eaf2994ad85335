// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <string>

namespace ps {

/// @brief Pinhole camera without distortion; pixels; centres of pixels are at integers.
///
/// A point (X, Y, Z) in the camera frame (x right, y down, z forward, metres) falls on pixel
/// (fx X/Z + cx, fy Y/Z + cy). Hartley and Zisserman, Multiple View Geometry, section 6.1.
struct Intrinsics {
  int width = 0;
  int height = 0;
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;

  /// @return (u, v) in pixels; meaningful for Z > 0 only
  Eigen::Vector2d project(const Eigen::Vector3d& point_in_cam) const {
    return {fx * point_in_cam.x() / point_in_cam.z() + cx,
            fy * point_in_cam.y() / point_in_cam.z() + cy};
  }

  /// @param depth  metres along z
  /// @return the point in the camera frame that pixel (u, v) sees at that depth
  Eigen::Vector3d lift(double u, double v, double depth) const {
    return {(u - cx) / fx * depth, (v - cy) / fy * depth, depth};
  }

  /// @return metres that one pixel covers at one metre of depth: 1 / sqrt(fx fy)
  double footprint_per_metre() const { return 1.0 / std::sqrt(fx * fy); }
};

/// Camera-to-world, metres.
using Pose = Eigen::Isometry3d;

/// @brief Throws ps::Error, naming `where`, unless the size is positive, the focal lengths are
/// positive and everything is finite.
void check(const Intrinsics& intrinsics, const std::string& where);

/// @brief Throws ps::Error, naming `where`, unless everything is finite and the upper left 3x3 is a
/// rotation (orthonormal to 1e-3, determinant +1).
/// @return the pose with its rotation made exactly orthonormal
Pose checked_pose(const Eigen::Matrix4d& world_from_cam, const std::string& where);

/// @brief Intrinsics of the same camera after its image is resized to width x height.
/// The half pixel is accounted for: cx' = (cx + 1/2) s - 1/2.
Intrinsics resized(const Intrinsics& intrinsics, int width, int height);

/// @param horizontal_fov_deg  full angle across the image's width, in (0, 180)
/// @return square pixels, principal point in the middle; throws ps::Error when out of range
Intrinsics intrinsics_from_fov(int width, int height, double horizontal_fov_deg);

/// @param focal_mm_35  focal length in 35 mm equivalent; by CIPA DCG-001 the diagonal of the frame
/// is 43.27 mm
Intrinsics intrinsics_from_focal_35mm(int width, int height, double focal_mm_35);

}  // namespace ps
