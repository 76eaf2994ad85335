// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include "libps/geometry/lift.h"

namespace ps::apps {

/// @brief The options that `scene` and `fuse` share: which pixels become points.
void add_lift_options(CLI::App& verb, LiftOptions& options);

/// @brief Throws CLI::ValidationError (wrong usage) when the range of depths is empty.
void check_depth_range(const LiftOptions& options);

}  // namespace ps::apps
