// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "libps/geometry/view.h"

namespace ps::stress {

struct SuiteOptions;

/// @brief Real frames that take the place of procedural rooms (SuiteOptions::given). Their depths
/// and poses are taken to be true; 0 = not known. Of any size: axes make them smaller.
struct GivenFrames {
  struct Walk {
    std::vector<View> frames;    ///< to be fused
    std::vector<View> held_out;  ///< of the same world, to be rendered
  };
  struct Pair {
    View photo, target;  ///< the target is what another camera sees
  };
  std::vector<Walk> walks;  ///< for fusion_axes() and cloud_axes()
  std::vector<Pair> pairs;  ///< for photo_axes()
};

/// Frames of one world, by their numbers.
struct WalkChoice {
  std::vector<std::size_t> frames, held_out;  ///< rising
};

/// @brief Chooses frames to be fused and frames to be left out between them: of each world
/// options.frames and options.held_out at most, fewer of both where it has fewer. They are spread
/// evenly over the world's frames, or over so much of their middle that neighbours overlap: turned
/// by 30 degrees and moved by half a metre at most.
/// @param worlds  of each frame
/// @param pose    of frame i, world_from_cam
/// @return for the first options.rooms worlds of three frames and more
std::vector<WalkChoice> choose_walks(const std::vector<int>& worlds,
                                     const std::function<Pose(std::size_t)>& pose,
                                     const SuiteOptions& options);

}  // namespace ps::stress
