// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "libps/models/model_options.h"
#include "libps/nn/linear.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"

namespace ps::models {

class Layers;

/// @brief The U-Net that guesses depth from one image (SPEC.md 3; `pts_regressor.*`).
class DepthNet {
 public:
  /// Batch norms behind each convolution, by their published names; "" = none. There is none behind
  /// the last of the decoder.
  static constexpr const char* kEncoderNorms[] = {"",
                                                  "batch_norm2_0",
                                                  "batch_norm4_0",
                                                  "batch_norm8_0",
                                                  "batch_norm8_1",
                                                  "batch_norm8_2",
                                                  "batch_norm8_3",
                                                  ""};
  static constexpr const char* kDecoderNorms[] = {"batch_norm8_4", "batch_norm8_5", "batch_norm8_6",
                                                  "batch_norm8_7", "batch_norm4_1", "batch_norm2_1",
                                                  "batch_norm"};

  static constexpr int kMultiple = 256;  ///< of an image's sides: it is halved eight times

  explicit DepthNet(const nn::Weights& weights, const ModelOptions& options = {});

  /// @param image  [n, h, w, 3], RGB in [-1,1], sides multiples of 256
  /// @param raw    [n, h, w, 1], any value; see depth_of_raw()
  void forward(const nn::TensorView& image, const nn::TensorView& raw,
               nn::Workspace& workspace) const;

 private:
  DepthNet(const Layers& layers, nn::Storage storage);

  static constexpr std::size_t kLevels = 8;
  /// What the encoder made at each level: a slice of what the decoder reads there.
  using Skips = std::array<nn::TensorView, kLevels>;
  void encode(const nn::TensorView& image, const Skips& skips, nn::Workspace& workspace) const;

  std::vector<nn::Convolution> encoder_;  ///< each halves the sides
  std::vector<nn::Convolution> decoder_;  ///< all but the last; each after doubling them
  nn::Linear last_;                       ///< the last one's nine taps, one channel each
  float last_bias_ = 0;
};

/// @brief depth = min_z + (max_z - min_z) * sigmoid(raw), in the unit of min_z; `depth` may be
/// `raw`.
void depth_of_raw(const nn::TensorView& raw, float min_z, float max_z, const nn::TensorView& depth);

}  // namespace ps::models
