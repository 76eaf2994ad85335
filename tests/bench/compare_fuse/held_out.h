// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "io/rgbd_folder.h"

namespace ps {

/// @return whether frame i (0-based, in the trajectory's order) is left out of fusing; with
/// hold_out 0 none is. The same rule as `pixelsynth fuse --hold-out N`.
inline bool is_held_out(std::size_t i, std::size_t hold_out) {
  return hold_out > 0 && i % hold_out == hold_out / 2;
}

/// @return the folder's frames that are held out, or those that are not
inline std::vector<RgbdFrame> chosen_frames(const RgbdFolder& folder, std::size_t hold_out,
                                            bool held_out) {
  std::vector<RgbdFrame> frames;
  for (std::size_t i = 0; i < folder.frames.size(); ++i) {
    if (is_held_out(i, hold_out) == held_out) frames.push_back(folder.frames[i]);
  }
  return frames;
}

}  // namespace ps
