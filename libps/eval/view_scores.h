// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "libps/eval/pairs.h"
#include "libps/eval/perceptual.h"

namespace ps {

/// How near a picture of a view comes to what is truly seen there.
struct ViewScores {
  double psnr = 0;            ///< dB, over all pixels
  double psnr_visible = 0;    ///< over what the input sees too; NaN where that is nothing
  double psnr_invisible = 0;  ///< over what it does not; NaN likewise
  double ssim = 0;            ///< image_metrics.h
  double perceptual = 0;      ///< NaN when not measured
};

/// @param visibility  true_visibility() of input and target; masks without a pixel = it is not
/// known, and neither are the scores of its two parts (NaN)
/// @param perceptual  may be empty
/// Throws ps::Error when sizes differ, and as `perceptual` does.
ViewScores view_scores(const Image& shown, const Image& truth, const Visibility& visibility,
                       const PerceptualDistance& perceptual = {});

/// @brief Frechet distances between the pictures that methods make and true ones (frechet.h).
class FrechetScores {
 public:
  /// What the network looks with must outlive this.
  explicit FrechetScores(FeatureNetwork network) : network_(std::move(network)) {}

  void add_truth(const Image& image) { add("", image); }
  /// Throws ps::Error when the network gives more or fewer features of one image than of another.
  void add(const std::string& method, const Image& image);

  const FeatureNetwork& network() const { return network_; }
  std::size_t count(const std::string& method) const;  ///< pictures added

  /// @return NaN of fewer than two pictures, or fewer than two true ones
  double distance(const std::string& method) const;

 private:
  FeatureNetwork network_;
  std::map<std::string, std::vector<std::vector<float>>> features_;  ///< "" = the truth
};

}  // namespace ps
