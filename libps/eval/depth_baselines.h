// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "libps/core/image.h"

namespace ps {

/// @brief Depths that are guessed without a look at the photo, for estimates to be held against.
/// They learn from the very depths that they are then scored on, which is in their favour.
class DepthBaselines {
 public:
  /// Unknown depths (0, negative, not finite) are left out; an image without any teaches nothing.
  void learn(const Depth& truth);

  /// @return metres everywhere: the median of all images' median depths. Throws ps::Error when
  /// nothing was learnt.
  Depth constant(cv::Size size) const;

  /// @return the same times each row's usual share of its image's median depth (floors are near at
  /// the lower edge, far above it). Throws as constant() does.
  Depth ramp(cv::Size size) const;

 private:
  static constexpr int kBins = 64;  ///< of an image's height

  std::vector<double> medians_;
  std::array<double, kBins> log_sum_{}, count_{};
};

}  // namespace ps
