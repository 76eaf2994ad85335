// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/train/train.h"

namespace ps::apps {

extern "C" {
/// @brief train::train(), in the part of the program that brings libtorch along.
void pixelsynth_train(const train::TrainOptions& options, const train::TrainProgress& progress,
                      train::TrainReport* report);
}

}  // namespace ps::apps
