// SPDX-License-Identifier: BSD-3-Clause
#include "apps/train_part.h"

namespace ps::apps {

void pixelsynth_train(const train::TrainOptions& options, const train::TrainProgress& progress,
                      train::TrainReport* report) {
  *report = train::train(options, progress);
}

}  // namespace ps::apps
