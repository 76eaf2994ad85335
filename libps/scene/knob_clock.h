// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room.
#pragma once

#include "libps/core/clock.h"

namespace ps {

/// @return seconds that `task` took
template <class Task>
double seconds_of(const Task& task) {
  const Instant start = now();
  task();
  return seconds_since(start);
}

}  // namespace ps
