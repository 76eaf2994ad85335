// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "libps/core/image.h"
#include "libps/geometry/camera.h"
#include "libps/geometry/depth_alignment.h"
#include "libps/geometry/view.h"
#include "libps/models/depth_net.h"

namespace ps {

/// @brief What a DepthNet's weights were trained to; their file says so (`min_z`, `max_z` and
/// `canonical_focal` of its metadata).
struct DepthScale {
  float min_z = 1;             ///< the least depth that the network can say, metres; above 0
  float max_z = 100;           ///< and the greatest
  double canonical_focal = 1;  ///< of the camera that it takes all squares to be from, in sides
};

/// @brief Throws ps::Error, naming `where`, unless 0 < min_z < max_z, canonical_focal > 0, and all
/// are finite.
void check(const DepthScale& scale, const std::string& where);

/// @brief Guesses the depth of a photo of any size, of an aspect up to 100, and of any focal
/// length.
///
/// Nothing is squashed: the photo is resized to a short side of 256 pixels, and its long side is
/// covered by overlapping squares. The depths of one are multiplied by a constant (the median ratio
/// where they overlap) to go on from its neighbour's, then all are blended in their logarithm, with
/// weights that fall to 0 towards a square's ends, and resized to the photo's size.
///
/// An image alone does not tell a large thing far away from a small one nearby, nor a long lens
/// from either. So the network takes each square to be from one canonical camera (Yin et al.,
/// "Metric3D", ICCV 2023), and true depth = the network's * focal length / (canonical_focal * 256),
/// the focal length in pixels of the square. Right proportions within the photo are all that can be
/// hoped for; metres are right as far as the photo's things have the sizes the network has seen.
/// @param photo  not empty
/// @param lens   of the photo; only sqrt(fx * fy) matters
/// @return metres along z, of the photo's size; every pixel has one. Not limited to max_z, where
/// the lens is longer than the canonical one.
/// Throws ps::Error when the photo is empty or too long, lens or scale are unsound, or the network
/// gives what is not finite.
Depth photo_depth(const models::DepthNet& net, const Image& photo, const Intrinsics& lens,
                  const DepthScale& scale = {});

/// @brief A photo's measured depth, its holes filled by the network's, which is made to continue it
/// (depth_alignment.h). What was measured stays. Throws ps::Error as photo_depth() does.
AlignedDepth completed_depth(const models::DepthNet& net, const View& photo,
                             const DepthScale& scale = {});

}  // namespace ps
