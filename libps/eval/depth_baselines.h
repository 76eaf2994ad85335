// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "libps/core/image.h"

namespace ps {

/// @brief Depths that are guessed without a look at the photo, for estimates to be held against.
/// They learn from the very depths that they are then scored on, which is in their favour; mean()
/// alone leaves out the one.
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

  /// @return the mean of the logarithm over the other images, at each place of a grid of 64x64.
  /// Where they know nothing, constant(). Throws as that does.
  /// @param truth  that is left out, one of those that were learnt; its size is the result's
  Depth mean(const Depth& truth) const;

 private:
  static constexpr int kBins = 64;  ///< of an image's height, and for mean() its width

  /// Of the images' mean logarithms at each place: their sum, and how many there are.
  struct Logs {
    cv::Mat1d sum = cv::Mat1d::zeros(kBins, kBins), count = cv::Mat1d::zeros(kBins, kBins);
  };
  static cv::Range part(int bin, int side);
  static Logs logs_of(const Depth& truth);

  std::vector<double> medians_;
  std::array<double, kBins> log_sum_{}, count_{};
  Logs logs_;
};

}  // namespace ps
