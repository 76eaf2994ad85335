// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "libps/core/image.h"

namespace ps::apps {

/// One line of a chart; what is not finite is left out.
struct PlottedCurve {
  std::string name;
  std::vector<double> y;  ///< one for each of the chart's x
};

struct CurveChart {
  std::string title, x_label, y_label;
  std::vector<double> x;  ///< at even distances, whatever they are
  std::vector<PlottedCurve> curves;
  double limit = 0;  ///< a dashed line across
};

/// @return the chart, 720x420
Image curve_picture(const CurveChart& chart);

}  // namespace ps::apps
