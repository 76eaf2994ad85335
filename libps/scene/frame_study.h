// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/scene/fuse.h"

namespace ps {

struct FrameStudyOptions {
  bool gains = true;   ///< even out exposure and white balance
  bool scales = true;  ///< even out the scales of depths, if they agree much better then
  bool refuse = true;  ///< leave out frames that the others contradict
  int width = 128;     ///< pixels across to which frames are reduced, at most
  int partners = 16;   ///< other frames that a frame is held against, at most
  /// Two depths along a ray contradict each other when they differ by more than this share beyond
  /// all depths around the pixel.
  double tolerance = 0.08;
  /// A frame is left out when in the pair that speaks for it more than this share of what both see
  /// is contradicted, and more than three times what is usual among the frames with a pair: the
  /// worst first, then the worst of the others. First the pair speaks that is worse than about two
  /// fifths of a frame's pairs, and usual is the frame worse than three tenths: that finds frames
  /// lost each for itself, up to nearly half. Then both are those in the middle: that finds frames
  /// lost together, which agree with their neighbours. None is left out, if that would be half of
  /// those with a pair, or if more than this share is still contradicted in the middle one of the
  /// frames that are left: the study gives up then.
  double contradicted = 0.15;
};

/// What the other frames say about one.
struct FrameWord {
  cv::Vec3f gain = {1, 1, 1};  ///< its colours times this are as bright as the others'
  double scale = 1;            ///< its depths times this agree with the others'
  double contradicted = 0;     ///< share, in the middle one of its pairs; 0 without a pair
  bool refused = false;
  bool alone = false;  ///< it has depth, but no frame that it was held against shares a surface
};

struct FrameStudy {
  std::vector<FrameWord> words;  ///< one for each frame; those of empty frames change nothing
  /// Too many frames contradict the others: none is refused, and nothing is evened out.
  bool gave_up = false;
  /// The middle |log ratio| of two frames' depths of one surface, whatever it comes from: noise,
  /// poses, lenses. 0 where no two frames see the same.
  double spread = 0;
};

/// @brief Holds posed RGB-D frames against each other before they are fused: each is reduced, its
/// pixels are lifted and projected into other frames, near ones in the source's order and others
/// evenly spread. Gains (one for each channel) and scales are the least squares of all pairs'
/// median log ratios, and average to 1 in the logarithm: as photo stitchers even exposures out
/// (Brown and Lowe, IJCV 2007, section 6), by ratios where those have differences.
/// @param source  read once, in order
/// Throws ps::Error when an option is unsound or a frame is; errors of load() are passed on.
FrameStudy study_frames(const ViewSource& source, const FrameStudyOptions& options = {});

/// @return the source with the words heeded: gains and scales applied, depths that no neighbour
/// shares removed (lone_pixels.h), empty views for refused frames and those that no depth is left
/// of. Throws ps::Error when there are more or fewer words than frames.
ViewSource heeding(const ViewSource& source, const FrameStudy& study);

/// @return the options with a tolerance that takes two frames' depths of one surface for one: as it
/// is for good frames, more where they spread
FuseOptions heeding(const FuseOptions& options, const FrameStudy& study);

}  // namespace ps
