// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "libps/eval/statistics.h"

namespace ps {

/// What one column of a table says.
struct ScoreColumn {
  std::string name;  ///< "AbsRel", "Frechet distance on SqueezeNet 1.1 fire-9 features", ...
  std::string unit;  ///< "m", "dB"; empty where there is none
  bool higher_is_better = false;
};

/// One method's scores on one sample.
struct ScoreRow {
  std::string method;
  std::string sample;          ///< the frame, or the pair of frames
  int group = 0;               ///< samples of one group are alike (bootstrap_mean())
  std::vector<double> values;  ///< one for each column; NaN = not measured
};

/// @brief Scores of methods on samples, and what they come to: METHOD x SCORE.
class ScoreTable {
 public:
  explicit ScoreTable(std::vector<ScoreColumn> columns) : columns_(std::move(columns)) {}

  /// Throws ps::Error unless the row has a value for each column.
  void add(ScoreRow row);

  const std::vector<ScoreColumn>& columns() const { return columns_; }
  const std::vector<ScoreRow>& rows() const { return rows_; }
  /// @return in the order in which they first came
  const std::vector<std::string>& methods() const { return methods_; }

  /// @return the mean of a method's scores in one column, without NaN
  Interval mean(const std::string& method, std::size_t column,
                const BootstrapOptions& options = {}) const;

 private:
  std::vector<ScoreColumn> columns_;
  std::vector<ScoreRow> rows_;
  std::vector<std::string> methods_;
};

}  // namespace ps
