// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace ps {

/// @brief Sets how many threads parallel loops use; 0 means one for each core.
/// Results never depend on it. Not to be called while a parallel loop runs.
void set_threads(int count);

/// @return the number of threads in use, at least 1
int threads();

/// @brief Calls `body(i)` once for every i in [0, count), on all threads.
///
/// Iterations may run in any order and must not depend on each other; whatever they write must not
/// depend on the thread. A loop started inside a loop runs on the calling thread alone. Returns
/// when all are done. Once one throws no more begin; the error of the smallest i is thrown again.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

/// @brief Splits [0, count) into `chunk`-sized ranges and calls `body(begin, end)` for each.
/// The ranges depend on `chunk` alone, not on the number of threads.
void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace ps
