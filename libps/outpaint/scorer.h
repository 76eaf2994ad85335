// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "libps/models/classifier.h"
#include "libps/models/discriminator.h"
#include "libps/nn/tensor.h"

namespace ps::outpaint {

/// @brief An opinion about a picture. The picture is [1, h, w, 3], dense, RGB in [-1,1].
struct Scorer {
  std::string name;
  bool higher_is_better = true;
  std::function<double(const nn::TensorView& image, nn::Workspace& workspace)> score;
};

/// How real it looks (SPEC.md 9). The network must outlive the scorer, here and below.
Scorer discriminator_scorer(const models::Discriminator& network);
/// How certain a scene classifier is: the entropy of its softmax, lower is better.
Scorer entropy_scorer(const models::Classifier& network);

}  // namespace ps::outpaint
