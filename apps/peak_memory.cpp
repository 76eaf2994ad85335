// SPDX-License-Identifier: BSD-3-Clause
#include "apps/peak_memory.h"

#include <sys/resource.h>

namespace ps::apps {

double peak_memory_mib() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace ps::apps
