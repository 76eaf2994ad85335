// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libps/geometry/camera.h"

namespace ps {

/// One posed frame of a trajectory.
struct StampedPose {
  double timestamp = 0;  ///< TUM and RealEstate10K; frame number in Open3D .log; image id in COLMAP
  Pose world_from_cam = Pose::Identity();
  std::string name;  ///< COLMAP's image name; else empty
  /// RealEstate10K's fx fy cx cy as shares of the width and height; else empty.
  std::optional<Eigen::Vector4d> normalised_intrinsics;
};

enum class TrajectoryFormat { tum, colmap_images, open3d_log, realestate10k };

/// @brief Reads camera poses; the format is told from the name and content: TUM
/// (`stamp tx ty tz qx qy qz qw`, camera-to-world), COLMAP images.txt (world-to-camera), Open3D
/// `.log` (camera-to-world 4x4), RealEstate10K (19 columns, world-to-camera 3x4).
/// Throws ps::Error with the line's number on NaN, infinities, non-rotations, zero quaternions,
/// missing columns, a timestamp that comes twice, and when there is no pose at all.
std::vector<StampedPose> read_trajectory(const std::filesystem::path& path);

/// @brief The same from a file's bytes; `name` stands in messages and helps to tell the format.
std::vector<StampedPose> parse_trajectory(std::string_view bytes, const std::string& name);

/// @brief Writes poses; the file appears whole or not at all. COLMAP's images.txt gets camera id 1,
/// empty point lines, and names made from the ids (00003.png) where there is none. Its ids and
/// Open3D's frame numbers are the timestamps where these are whole and differ, else 1, 2, ... and
/// 0, 1, ...
/// Throws ps::Error when a pose is unsound, or for RealEstate10K lacks normalised_intrinsics; for
/// TUM and RealEstate10K also when two poses have one timestamp.
void write_trajectory(const std::filesystem::path& path, const std::vector<StampedPose>& poses,
                      TrajectoryFormat format = TrajectoryFormat::tum);

}  // namespace ps
