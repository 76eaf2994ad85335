// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "libps/models/model_options.h"
#include "libps/nn/linear.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"

namespace ps::models {

class Layers;

/// @brief ResNet-18 (He and others, CVPR 2016) with torchvision's names under `classifier.`, or
/// bare where the weights have no such prefix; any number of classes.
class Classifier {
 public:
  explicit Classifier(const nn::Weights& weights, const ModelOptions& options = {});

  int classes() const { return last_.matrix().columns(); }

  /// @brief What the network was trained on: `image` in [-1,1], RGB, shifted and scaled by
  /// ImageNet's means and deviations. Resizing (the training size is 224x224) is the caller's.
  /// `out` may be `image`.
  static void normalise(const nn::TensorView& image, const nn::TensorView& out);

  /// @param input   [n, h, w, 3] from normalise(), any size
  /// @param logits  [n, 1, 1, classes()]
  void forward(const nn::TensorView& input, const nn::TensorView& logits,
               nn::Workspace& workspace) const;

 private:
  explicit Classifier(const Layers& layers);

  struct Block {
    nn::Convolution convolution1, convolution2;
    std::vector<nn::Convolution> straight;  ///< of the other path; none = that path is x itself
  };
  static std::vector<Block> read_blocks(const Layers& layers, int in);
  static void run(const Block& block, const nn::TensorView& x, const nn::TensorView& out,
                  nn::Workspace& workspace);

  nn::Convolution first_;
  std::vector<Block> blocks_;
  nn::Linear last_;
};

}  // namespace ps::models
