// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: procedural rooms that are put under stress, and what goes wrong.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "libps/geometry/point.h"
#include "libps/geometry/view.h"
#include "libps/rooms/room.h"
#include "libps/scene/stress_given.h"

namespace ps::stress {

/// Frames of a room, views of it that were left out, and its true surface.
struct World {
  std::vector<View> frames, held_out;
  std::vector<Mask> covered;  ///< of views left out: pixels whose surface frames see
  Cloud truth;                ///< all pixels of the frames, lifted
};

/// @brief A room that somebody walks about in, looking around.
World make_world(std::uint64_t seed, int frames, int held_out, cv::Size size);

/// @return the world of these frames and views left out, with its truth and what is covered
World completed(World world);

/// @brief A world of given frames, made smaller than `size`, whatever their aspect.
World given_world(const GivenFrames::Walk& walk, cv::Size size);

/// @brief A photo, and what other cameras see.
struct Photo {
  View view;            ///< holes of its depth are yet to be filled
  View known;           ///< the same, with depth where it is known to be true
  Intrinsics lens;      ///< of the camera elsewhere, unless an axis moves it
  Pose world_from_cam;  ///< of that camera
  std::function<View(const Intrinsics&, const Pose&)> shoot;  ///< what a camera truly sees
};

/// @brief A photo of a room; every pixel has a depth. The camera elsewhere is turned to the right
/// by 20 degrees and moved by 20 cm.
Photo make_photo(std::uint64_t seed, cv::Size size, const rooms::RoomOptions& options = {});

/// @brief A photo that is given, and the target; nothing is known of other cameras.
Photo given_photo(const GivenFrames::Pair& pair, cv::Size size);

/// @brief The photo's camera, elsewhere: turned to the right (degrees), then moved along its own
/// axes (metres).
Pose moved_pose(const Pose& pose, double degrees, const Eigen::Vector3d& metres);

/// What a disturbance is drawn from.
struct Draw {
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
};

// All take the undisturbed view. Shares are of 1.

/// Normal, sigma a share of the depth, at each pixel.
View with_noise(const View& view, double share, const Draw& draw);
/// All depths times 1 + share.
View with_bias(const View& view, double share);
/// All depths of a frame times a factor of log-normal spread `share`.
View with_scale(const View& view, double share, const Draw& draw);
/// No depth in that share of the pixels, in blots.
View with_holes(const View& view, double share, const Draw& draw);
/// Depth smeared over edges by a box of so many pixels, as sensors and networks do.
View with_soft_edges(const View& view, double pixels);
/// Turned by a random rotation of so many degrees, and moved by 2 cm for each degree.
View with_pose_noise(const View& view, double degrees, const Draw& draw);
/// Exposed so many stops more (in linear light), and clipped.
View with_exposure(const View& view, double stops);
/// Taken to be from a lens whose focal length is wrong by this share.
View with_focal(const View& view, double share);
/// Taken to be from a lens whose principal point is off to the right by this share of the width.
View with_principal_point(const View& view, double share);
/// Panes: within that share of the picture, at each pixel by chance nothing, what is right, or the
/// depth of something else up to three times as far.
View with_glass(const View& view, double share, const Draw& draw);

/// A round mirror of this radius, metres, on what the first frame's middle shows: the depth there
/// is that of what it reflects, the walls of the box that all frames see.
std::vector<View> with_mirror(const std::vector<View>& frames, double radius);
/// So many times narrower, at least 2 pixels wide.
View shrunk(const View& view, double times);
/// Shrunk where it is larger than `most`, so that it is not.
View reduced(const View& view, cv::Size most);

/// @return a pixel's normal numbers: a function of (draw, x, y)
double normal_at(const Draw& draw, int x, int y);
/// @return even in [0, 1): a function of (draw, k)
double even_at(const Draw& draw, std::uint32_t k);
/// @return the share of the picture where it is 1, in blots
Mask blots(cv::Size size, double share, const Draw& draw);

}  // namespace ps::stress
