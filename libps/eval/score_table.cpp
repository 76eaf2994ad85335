// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/score_table.h"

#include <algorithm>
#include <utility>

#include "libps/core/error.h"

namespace ps {

void ScoreTable::add(ScoreRow row) {
  if (row.values.size() != columns_.size()) {
    throw Error(row.method + " on " + row.sample, std::to_string(row.values.size()) + " scores",
                std::to_string(columns_.size()) + ", one for each column");
  }
  if (std::find(methods_.begin(), methods_.end(), row.method) == methods_.end()) {
    methods_.push_back(row.method);
  }
  rows_.push_back(std::move(row));
}

Interval ScoreTable::mean(const std::string& method, std::size_t column,
                          const BootstrapOptions& options) const {
  std::vector<double> values;
  std::vector<int> groups;
  for (const ScoreRow& row : rows_) {
    if (row.method != method) continue;
    values.push_back(row.values.at(column));
    groups.push_back(row.group);
  }
  return bootstrap_mean(values, groups, options);
}

}  // namespace ps
