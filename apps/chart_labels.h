// SPDX-License-Identifier: BSD-3-Clause
// Internal to charts: words beside dots.
#pragma once

#include <string>
#include <vector>

#include "apps/drawing.h"

namespace ps::apps {

struct ChartLabel {
  cv::Point2d at;  ///< of its dot
  std::string words;
};

/// @brief Writes labels where they hide least of what is drawn already, with thin lines to those
/// that stand far from their dots.
/// @param plot   that they should stay in
/// @param taken  by dots
void add_labels(const std::vector<ChartLabel>& labels, const cv::Rect2d& plot,
                std::vector<cv::Rect2d> taken, Drawing& drawing);

}  // namespace ps::apps
