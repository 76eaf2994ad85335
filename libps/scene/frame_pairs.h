// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: frames held against each other in pairs (frame_study.h).
#pragma once

#include <string>
#include <vector>

#include "libps/scene/frame_study.h"

namespace ps {

constexpr std::size_t kLeastOverlap = 40;  ///< pixels; less is no pair
constexpr double kAgreeing = .05;          ///< share of a depth; lone_pixels.h

/// A frame, reduced, and the least and greatest depth around each of its pixels, metres.
struct SmallFrame {
  View view;
  Depth nearest, farthest;
  bool usable() const { return !view.depth.empty(); }
};

/// @param width  pixels, at most
/// @return an empty one of an empty view. Throws ps::Error when the view is unsound.
SmallFrame reduced_frame(const View& view, int width, const std::string& where);

/// What a pair says of one ratio, in the logarithm, and how much it is to be believed.
struct MiddleRatio {
  double ratio = 0, weight = 0;
};

/// @brief What two frames say of each other. It keeps no pixels: those of the pairs of a thousand
/// frames would fill gigabytes.
struct FramePair {
  std::size_t a = 0, b = 0;
  std::size_t agree = 0, before = 0;  ///< pixels; before: the other frame sees through it
  MiddleRatio color[3], depth;        ///< of a over b
  double apart = 0;                   ///< the middle |log ratio| of depths, if the pair overlaps
  bool overlaps() const { return agree >= kLeastOverlap; }
};

/// @return pairs of frames near each other in the stream, and of others evenly spread
std::vector<FramePair> plan_pairs(const std::vector<SmallFrame>& frames, int partners);

/// @brief Fills the pairs, by frames whose depths are scaled as their words say.
/// @param tolerance  share of a depth that the other frame's may differ by
void hold_against_each_other(const std::vector<SmallFrame>& frames,
                             const std::vector<FrameWord>& words, double tolerance,
                             std::vector<FramePair>* pairs);

}  // namespace ps
