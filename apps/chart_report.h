// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/chart_picture.h"
#include "apps/score_report.h"
#include "libps/eval/knob.h"

namespace ps::apps {

/// A knob that was measured.
struct KnobChart {
  Knob knob;
  KnobResult result;
  std::vector<TradeoffPoint> points;  ///< in the order of the settings
  std::vector<std::size_t> front;     ///< indices of points, by rising seconds
};

KnobChart chart_of(const Knob& knob, KnobResult result, const BootstrapOptions& options);

/// @return an address of one setting within a page: "radius-2"
std::string anchor_of(const KnobChart& chart, std::size_t setting);

/// @brief Accuracy against seconds with error bars and names; the Pareto front a line, the default
/// in a ring. Dots lead to anchor_of().
ChartPicture picture_of(const KnobChart& chart);

/// @return rows of settings with a * at the default and a + on the front: seconds, accuracy, change
/// against the default, and the other scores
ScoreSummary summary_of(const KnobChart& chart, const BootstrapOptions& options);

/// @return a line for each point of all knobs
std::string to_csv(const std::vector<KnobChart>& charts);

/// @return by knob: what it is, what seconds and accuracy are of, its points
Json to_json(const std::vector<KnobChart>& charts);

/// @return the processor's name, cores, threads, and the load of the last minute
Json machine_report();

/// @return pictures of one size side by side, `columns` in a row, on white
Image grid_of(const std::vector<Image>& pictures, int columns);

}  // namespace ps::apps
