// SPDX-License-Identifier: BSD-3-Clause
// Internal to the outpaint room: how long everything takes.
#pragma once

#include <cstddef>

#include "libps/outpaint/outpainter.h"

namespace ps::outpaint {

/// About how long everything takes, for progress: milliseconds at the published widths.
struct Work {
  double encode, sample, decode, refine, refine_rest, score;  ///< of one completion
  double whole;                                               ///< at most

  /// @param samples  completions, at most
  /// @param missing  cells
  /// @param pixels   of the view
  /// @param changed  of these, those in which completions can differ
  Work(const OutpaintOptions& options, int samples, std::size_t missing, std::size_t scorers,
       double pixels, double changed);
};

}  // namespace ps::outpaint
