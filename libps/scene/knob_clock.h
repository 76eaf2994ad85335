// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room.
#pragma once

#include <chrono>

namespace ps {

/// @return seconds that `task` took
template <class Task>
double seconds_of(const Task& task) {
  const auto start = std::chrono::steady_clock::now();
  task();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace ps
