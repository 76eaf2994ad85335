// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/models/model_options.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"

namespace ps::models {

class Layers;

/// @brief Perceptual distance LPIPS v0.1 over SqueezeNet 1.1 (Zhang and others, CVPR 2018; names as
/// in `lpips_squeeze_v0.1.safetensors`: `net.*` are torchvision's features, `linK.model.1.weight`).
class Lpips {
 public:
  static constexpr int kSmallest = 17;  ///< an image's sides are at least this many pixels

  explicit Lpips(const nn::Weights& weights, const ModelOptions& options = {});

  /// @param a, b  [n, h, w, 3], RGB in [-1,1]
  /// @param distances  n values, 0 = the same; most pairs are below 1
  void distance(const nn::TensorView& a, const nn::TensorView& b, float* distances,
                nn::Workspace& workspace) const;

  /// @brief What the network makes of whole images: fire 9's outputs (torchvision's `features.12`),
  /// each the mean over the pixels.
  /// @param images  [n, h, w, 3], RGB in [-1,1]
  /// @param features  n times feature_count() values, none below 0
  void features(const nn::TensorView& images, float* features, nn::Workspace& workspace) const;
  int feature_count() const;  ///< 512 at the published widths

 private:
  /// SqueezeNet's: 1x1 to few channels, then 1x1 and 3x3 side by side.
  struct Fire {
    nn::Convolution squeeze, expand1, expand3;
    bool pooled;                 ///< max pooling comes before it
    std::vector<float> weights;  ///< of its channels' differences; none = it is not compared
  };
  explicit Lpips(const Layers& layers);
  static std::vector<Fire> read_fires(const Layers& layers, int in);
  nn::TensorView first(const nn::TensorView& scaled, nn::Workspace& workspace) const;
  static nn::TensorView run(const Fire& fire, nn::TensorView x, nn::Workspace& workspace);

  nn::Convolution first_;
  std::vector<float> first_weights_;
  std::vector<Fire> fires_;
};

}  // namespace ps::models
