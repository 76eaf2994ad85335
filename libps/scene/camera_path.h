// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "libps/geometry/camera.h"

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace ps {

struct Point;

/// @brief How far a camera turns and moves on a built-in path.
struct PathOptions {
  int frames = 64;
  double range_horizontal = 0.6;  ///< radians to either side (SPEC.md 2)
  double range_vertical = 0.3;    ///< radians up and down
  double orbit_radius = 0;  ///< metres ahead to the point it turns about; 0 = turns on the spot
};

/// @return the eight directions of a scene's support views (SPEC.md 2), in this order: left, right,
/// up, down, up-left, up-right, down-left, down-right
const std::vector<std::string>& direction_names();

/// @return all built-in paths: circle, sway and the directions
const std::vector<std::string>& path_names();

/// @brief Camera poses along a built-in path; the first is `start`.
///
/// Each pose is start * R with R = Ry(yaw) Rx(pitch) (SPEC.md 2), about the camera's centre or
/// about the point orbit_radius ahead of it. A direction says where the camera looks: `left` ends
/// looking range_horizontal to the left of the start, a diagonal ends at half of both ranges; steps
/// are even. `sway` swings to the left extreme, through the start to the right one, and back.
/// `circle` goes once round an ellipse through the start, as wide as both horizontal extremes and
/// as high as the lower one: left, down, right and back. Both extremes are always among their
/// frames, and from four frames on both end where they started. A path of one frame is the start.
/// Throws ps::Error naming the choices when `name` is none of them, and when frames < 1, a range is
/// negative or beyond pi, or orbit_radius is negative or not finite.
std::vector<Pose> camera_path(const std::string& name, const Pose& start,
                              const PathOptions& options = {});

/// Where to look at a cloud from, when nobody says.
struct Framing {
  Pose world_from_cam = Pose::Identity();
  double distance = 0;  ///< metres from the camera to the middle of the cloud
};

/// @brief A camera that stands outside the cloud, level, and sees all of it but its outermost 1 %
/// along each axis.
/// @param up  the world's axis that points up: x, y, z, or -x, -y, -z. With y the camera looks
/// along -z with x to the right. Throws ps::Error when the cloud is empty, the intrinsics are
/// unsound or `up` is none of these.
Framing frame_cloud(const pcl::PointCloud<Point>& cloud, const Intrinsics& intrinsics,
                    const std::string& up = "y");

/// @return the world's axis (x, y, z, -x, -y or -z) nearest to where the cameras' tops point, on
/// average; "y" for no poses
std::string up_axis(const std::vector<Pose>& world_from_cam);

/// @brief The same lens behind a picture of another size: keeps the horizontal field of view and
/// square pixels, and crops or extends the height evenly, so nothing is squashed.
Intrinsics with_size(const Intrinsics& intrinsics, int width, int height);

}  // namespace ps
