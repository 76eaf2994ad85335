// SPDX-License-Identifier: BSD-3-Clause
#include "apps/train_part.h"

#include <malloc.h>

namespace ps::apps {

void pixelsynth_train(const train::TrainOptions& options, const train::TrainProgress& progress,
                      train::TrainReport* report) {
  // A step gives back what the next one takes again: without this, a tenth of the time goes to the
  // kernel, which clears the pages.
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  *report = train::train(options, progress);
}

}  // namespace ps::apps
