// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/train/dataset.h"

namespace ps::train {

/// @brief How a picture is changed before a network sees it.
struct Augmentation {
  bool crop = false;    ///< a random square of it, 60 to 100 % of its side, resized to the whole
  bool mirror = false;  ///< left for right, half of them
  bool jitter = false;  ///< brightness, contrast, saturation, hue and gamma
};

/// @brief Changes color, and with it depth, plain and lens (and nothing else), of a batch, each
/// example by itself. `plain` is not jittered.
void augment(Batch& batch, const Augmentation& how, torch::Generator generator);

}  // namespace ps::train
