// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libps/rooms/picture_plane.h"
#include "libps/rooms/plane_kernel.h"

namespace ps::rooms {

/// Evens out an image within surfaces, along rows, then along columns. Needs the plane's ends.
class PlaneSmoother {
 public:
  PlaneSmoother(const PicturePlane& plane, const std::vector<Vec>& image);

  /// The mean over five pixels, `apart` pixels apart; ends weigh half, so that each of four samples
  /// that repeat weighs the same. 2 * apart is at most kMargin.
  void share(int apart);
  /// The mean over three pixels, `apart` pixels apart, where their light is alike.
  void share_alike(int apart);

  Vec at(int x, int y) const;

  static constexpr int kMargin = 16;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * stride_ + kMargin + x;
  }
  plane_kernel::Stretch row_of(int x, int y, const std::vector<std::int32_t>& surfaces) const;
  /// @param kernel  takes `taps` stretches that are `apart` pixels apart, the middle one the own
  template <typename Kernel>
  void pass(Kernel kernel, int taps, int apart);

  int width_, height_, stride_;                           ///< rows have margins
  std::array<std::vector<float>, 3> from_, to_;           ///< planes of red, green, blue
  std::vector<std::int32_t> along_rows_, along_columns_;  ///< surfaces; -1 in margins
  std::vector<std::int32_t> nowhere_;                     ///< a row of -1
};

}  // namespace ps::rooms
