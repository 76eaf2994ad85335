// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "libps/geometry/view.h"

namespace ps {

/// Which two frames make an input and a target (SPEC.md 11); both ends are included.
struct PairRange {
  double least_rotation = 20, most_rotation = 60;  ///< degrees, of the relative rotation's angle
  double most_distance = 1;                        ///< metres between the centres
};

/// The paper's range for RealEstate10K, 20 to 60 degrees, is the default; this is Matterport's.
constexpr PairRange kWidePairs = {0, 120, 1};

struct FramePair {
  std::size_t source = 0, target = 0;  ///< indices of frames
  double rotation = 0;                 ///< degrees
  double distance = 0;                 ///< metres
};

/// @brief Chooses ordered pairs of different frames in range, at random but spread: no frame is the
/// source of two more pairs than another that could be. A function of the arguments alone.
/// @param worlds  for each pose, the world it is in; frames of two worlds are no pair. Empty = one.
/// @param most    how many at most
/// @return by source, then target
/// Throws ps::Error when the range is unsound or there are more or fewer worlds than poses.
std::vector<FramePair> choose_pairs(const std::vector<Pose>& world_from_cams,
                                    const std::vector<int>& worlds, const PairRange& range,
                                    std::size_t most, std::uint64_t seed = 0);

/// @brief The same pairs, where poses take work: they are asked for world by world, and of no more
/// worlds than it takes to know the pairs. Of many small worlds and few pairs that is few.
/// @param worlds  of each frame
/// @param pose    of frame i, world_from_cam; threads call it at once
/// Throws what `pose` does, too.
std::vector<FramePair> choose_pairs_lazily(const std::vector<int>& worlds,
                                           const std::function<Pose(std::size_t)>& pose,
                                           const PairRange& range, std::size_t most,
                                           std::uint64_t seed = 0);

/// Of the target's pixels: a pixel is in at most one of the two.
struct Visibility {
  Mask visible;    ///< its surface is seen by the source
  Mask invisible;  ///< it is not: beside the source's image, or hidden from it
};

/// @brief Which of the target's pixels show what the source sees, by true depth.
///
/// The target's pixel is lifted and held against the source's depths at the four pixels around its
/// projection: visible if it lies between these, where they are of one
/// surface, or is as deep as one of them, within 1 % and a footprint; else invisible if one is
/// nearer. In neither mask is a pixel whose depth is not known, or the source's there, or where all
/// of the source's are deeper, which cannot be.
///
/// Without depth of the target nothing is known: what the source does not see may stand before
/// what it does.
/// @param source, target  with depth; colours are not looked at and may be empty
/// Throws ps::Error when a lens or pose is unsound or a depth is not of its lens's size.
Visibility true_visibility(const View& source, const View& target);

}  // namespace ps
