// SPDX-License-Identifier: BSD-3-Clause
// Internal to the outpaint room: decoding, combining and refining the completions of one view.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "libps/models/autoencoder.h"
#include "libps/models/refiner.h"
#include "libps/outpaint/sampler.h"

namespace ps::outpaint {

/// @brief One completion's picture at a time. It is the same bytes whichever came before: what
/// completions cannot change is refined once, from the projection alone.
class ViewPictures {
 public:
  /// What the refiner's noise is drawn from.
  struct Noise {
    std::uint64_t seed;
    std::uint32_t view;
  };
  /// @param background  some of it not 0; must outlive this, as the networks
  /// @param region      whether only what completions can change is computed for each
  ViewPictures(const models::Autoencoder& autoencoder, const models::Refiner& refiner,
               const nn::TensorView& projection, const cv::Mat1b& background, Noise noise,
               bool region);

  /// The pixels in which completions can differ, or all when the region is off.
  const cv::Rect& changed() const { return changed_; }
  /// Whether there are pixels that completions cannot change.
  bool has_rest() const { return changed_.size() != background_.size(); }

  /// @brief Refines those. Once, before anything else.
  void refine_rest(nn::Workspace& workspace);

  /// @brief Decodes a completion and combines it with the projection.
  void decode(const std::vector<std::int32_t>& codes, nn::Workspace& workspace);
  /// @brief Copies what was combined, [1, h, w, 3].
  void copy_unrefined(const nn::TensorView& to) const;
  /// @brief Refines what was combined.
  void refine(nn::Workspace& workspace);
  /// @return the refined picture, [1, h, w, 3]
  nn::Tensor& image() { return image_; }

 private:
  void refine(const cv::Rect& part, nn::Workspace& workspace);

  const models::Autoencoder& autoencoder_;
  const models::Refiner& refiner_;
  const cv::Mat1b& background_;
  std::vector<float> noise_;
  cv::Rect missing_;  ///< the background, in whole cells
  cv::Rect decoded_;  ///< what is decoded of each completion
  cv::Rect changed_;
  nn::Tensor combined_;  ///< [1, h, w, 4]: the refiner's input
  nn::Tensor image_;
};

}  // namespace ps::outpaint
