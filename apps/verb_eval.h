// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include "apps/context.h"

namespace ps::apps {

// Each adds one measurement to `eval`.
void add_eval_depth(CLI::App& eval, const Context& context);
void add_eval_views(CLI::App& eval, const Context& context);
void add_eval_consistency(CLI::App& eval, const Context& context);
void add_eval_cloud(CLI::App& eval, const Context& context);
void add_eval_ab(CLI::App& eval, const Context& context);

}  // namespace ps::apps
