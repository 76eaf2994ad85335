// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "libps/eval/score_table.h"

namespace ps {

/// What one setting of a knob costs and gives.
struct TradeoffPoint {
  std::string knob, setting;
  bool is_default = false;
  Interval seconds;
  Interval accuracy;  ///< the more the better
  Interval change;    ///< of the accuracy against the default's, on the same samples
};

/// @brief The points that no other one beats: none is at least as fast and as accurate, and more so
/// in one of the two. Equal points do not beat each other; those whose seconds or accuracy are NaN
/// beat nothing and are left out.
/// @return indices by rising seconds; of equal ones the first comes first
std::vector<std::size_t> pareto_front(const std::vector<TradeoffPoint>& points);

/// @brief Intervals of means for comparing methods that were tried on the same samples: what is
/// easy or hard for all methods alike is taken away, as each value less its sample's mean over the
/// methods, which is then moved to the method's mean and stretched by sqrt(k / (k - 1)), k methods
/// (Cousineau, "Confidence intervals in within-subject designs", 2005; Morey, 2008), and
/// bootstrapped by groups.
/// @return in the order of table.methods(); of samples where some method has NaN nothing is taken,
/// but a method that has nothing but NaN has an interval of NaN, and takes no sample from others
/// Throws ps::Error when the methods were not tried on the same samples in the same order.
std::vector<Interval> within_samples(const ScoreTable& table, std::size_t column,
                                     const BootstrapOptions& options = {});

/// @brief Interval of the mean of `method`'s scores less `other`'s, sample by sample. Throws as
/// within_samples() does.
Interval mean_change(const ScoreTable& table, const std::string& method, const std::string& other,
                     std::size_t column, const BootstrapOptions& options = {});

}  // namespace ps
