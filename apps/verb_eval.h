// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include "apps/context.h"

namespace ps::apps {

/// The end of the help of verbs that score frames.
inline constexpr char kIntervalsHelp[] =
    "\nBelow each mean its 95 % bootstrap interval over rooms, or over twentieths of a walk; one "
    "sample has none.";

// Each adds one measurement to `eval`.
void add_eval_depth(CLI::App& eval, const Context& context);
void add_eval_views(CLI::App& eval, const Context& context);
void add_eval_consistency(CLI::App& eval, const Context& context);
void add_eval_cloud(CLI::App& eval, const Context& context);
void add_eval_ab(CLI::App& eval, const Context& context);

}  // namespace ps::apps
