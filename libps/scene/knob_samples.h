// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "libps/eval/knob.h"
#include "libps/eval/pairs.h"

namespace ps {

/// @brief Square views of a procedural room that knobs are tried on, exact, without camera effects.
/// Input and target are a pair of PairRange's default (20 to 60 degrees, a metre at most), with
/// four others of the same place. A function of its arguments alone; on all threads.
/// @param seed  of the room; take one that nothing was trained on
/// @param side  pixels
KnobSample room_sample(std::uint64_t seed, int side);

/// Which frames make a sample.
struct FrameSet {
  FramePair pair;
  std::vector<std::size_t> others;
};

/// @brief Samples of posed frames: pairs of choose_pairs(), and for each target the frames of its
/// world that look most like it, but for its neighbours: of a walk, the next frames show the same.
/// @param most      samples
/// @param apart     frames whose numbers differ by less than this are neighbours
/// @param worlds    of each frame
/// @param pose      of frame i, world_from_cam; asked for as choose_pairs_lazily() does
/// Throws as choose_pairs_lazily() does.
std::vector<FrameSet> choose_frame_sets(const std::vector<int>& worlds,
                                        const std::function<Pose(std::size_t)>& pose,
                                        std::size_t most, std::size_t apart, std::uint64_t seed);

}  // namespace ps
