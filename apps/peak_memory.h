// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ps::apps {

/// @return the most memory that this process has held so far
double peak_memory_mib();

}  // namespace ps::apps
