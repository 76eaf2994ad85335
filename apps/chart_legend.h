// SPDX-License-Identifier: BSD-3-Clause
// Internal to charts: what curves and rings are called.
#pragma once

#include <string>
#include <vector>

#include "apps/chart_picture.h"

namespace ps::apps {

/// @brief The legend of a chart, in as many lines as it takes. Names that are wider than a line
/// end in an ellipsis.
class ChartLegend {
 public:
  /// @param left, right  that it stays between, pixels
  ChartLegend(const ChartPicture& picture, double left, double right);

  /// @return what lines after the first one add, pixels
  double more_height() const;
  /// @param y  the middle of its first line
  void draw(double y, Drawing& drawing) const;

 private:
  struct Entry {
    std::string name;
    unsigned color = 0;
    bool line = false, dot = false, ring = false, dashed = false;
    double x = 0;
    int row = 0;
  };
  void add(Entry entry);

  double left_, right_, end_;
  int row_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace ps::apps
