// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "libps/models/model_options.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"

namespace ps::models {

class Layers;

/// @brief How real an image looks, at two scales (SPEC.md 9; `netD.*`).
class Discriminator {
 public:
  static constexpr std::size_t kScales = 2;
  static constexpr std::size_t kLayers = 5;
  /// Where each layer's output goes, by scale; a view without data is not wanted.
  using Maps = std::array<std::array<nn::TensorView, kLayers>, kScales>;
  using Shapes = std::array<std::array<nn::Shape, kLayers>, kScales>;

  explicit Discriminator(const nn::Weights& weights, const ModelOptions& options = {});

  /// @return the shapes of the maps of such images; the last layer's has one channel
  Shapes shapes(const nn::Shape& image) const;

  /// @param image  [n, h, w, 3], RGB in [-1,1]
  /// @param maps   layers 0 to 3 after their activation, 4 = D itself, any value
  void forward(const nn::TensorView& image, const Maps& maps, nn::Workspace& workspace) const;

  /// @brief The mean over scales of the mean of max(0, 1 + D): higher is better.
  /// @param scores  one for each image
  void score(const nn::TensorView& image, float* scores, nn::Workspace& workspace) const;

 private:
  using Scale = std::vector<nn::Convolution>;
  static Scale read_scale(const Layers& layers, const std::string& prefix);
  static void run(const Scale& scale, const nn::TensorView& image,
                  const std::array<nn::TensorView, kLayers>& maps, nn::Workspace& workspace);

  std::array<Scale, kScales> scales_;
};

}  // namespace ps::models
