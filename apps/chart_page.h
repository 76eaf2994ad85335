// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/chart_report.h"

namespace ps::apps {

/// @brief One web page that needs nothing else and runs nothing: each knob's chart, whose dots lead
/// to the pictures behind them, and its table.
/// @param options  of the table's intervals; those that chart_of() was given
/// @param about    a line on machine, data and seed
std::string html_of(const std::vector<KnobChart>& charts, const BootstrapOptions& options,
                    const std::string& about);

}  // namespace ps::apps
