// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "libps/core/image.h"

namespace ps {

struct DepthAlignmentOptions {
  double min_exponent = 0.5;  ///< at most 1
  double max_exponent = 2;    ///< at least 1
  /// Pixels over which what is left after the fit decays into the missing part; 0 = a third of the
  /// image's short side.
  double decay = 0;
  /// No agreement above this median |log ratio| after the fit; half of it where the exponent is at
  /// its least or greatest.
  double max_residual = 0.25;
  int min_pixels = 64;  ///< visible ones with both depths; no agreement with fewer
};

/// @brief An estimated depth that goes on where the cloud's ends.
struct AlignedDepth {
  /// Metres. The cloud's own where that is visible and known, else the aligned estimate. Every
  /// pixel has a positive finite depth, be it missing or not.
  Depth depth;
  bool agreed = false;  ///< else the estimate is not in `depth`, unless nothing was visible
  double scale = 1;     ///< log depth = exponent * log estimate + log scale
  double exponent = 1;
  double residual = 0;  ///< median |log ratio| after that, over visible pixels with both depths
  /// Median relative step of depth from the last visible pixels to their missing neighbours: after
  /// scale and exponent alone, and in `depth`. NaN where there are no such pairs.
  double seam_step_before = 0;
  double seam_step = 0;
  /// The same between visible pixels, one pixel before the seam: what surfaces have by their slant.
  double seam_step_seen = 0;
  std::string why;  ///< a short clause when not agreed
};

/// @brief Makes a view's estimated depth continue the cloud into the missing part, so that an
/// outpainted wall goes on from the seen one without a step (PixelSynth section 3.2 lifts new
/// pixels by estimated depth; Ranftl et al., PAMI 2022, for scale being what such estimates lack).
///
/// First a robust scale and exponent over the visible pixels. Then what is left, the logarithm of
/// the ratio, is averaged over a few visible pixels, away from depth edges, and continued beyond
/// the seam by a membrane that decays (`decay`). A visible pixel that is much nearer than the
/// fitted estimate says nothing of what is missing: it is a thing before a background. Where the
/// two cannot agree, the cloud's depth alone is continued, harmonic in 1/z: it stays between the
/// least and the greatest visible depth. Where nothing is visible, the estimate is taken as it is.
///
/// @param estimate     any unit
/// @param cloud_depth  metres, as Splat::expected_depth; counts where visible and not missing. Best
/// of a splat of radius 1 where that hits: wide splats see slanted surfaces too near
/// @param visible      not 0 where the cloud is seen
/// @param missing      not 0 where the estimate is wanted
/// Depths that are not within 1e-9 to 1e9 are unknown, so zeros, NaN and infinity are. The same
/// bytes for any number of threads. Throws ps::Error when sizes differ or are 0, when an option is
/// out of range, and when pixels are missing but no depth at all is known.
AlignedDepth align_depth(const Depth& estimate, const Depth& cloud_depth, const Mask& visible,
                         const Mask& missing, const DepthAlignmentOptions& options = {});

}  // namespace ps
