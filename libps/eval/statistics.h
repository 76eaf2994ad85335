// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace ps {

/// @return NaN of no values. NaN among the values gives NaN.
double mean(const std::vector<double>& values);

/// @return of an even number the mean of the middle two; NaN of no values. None may be NaN.
double median(std::vector<double> values);

/// A figure and what it would be of other samples like these.
struct Interval {
  double value = 0;
  double low = 0, high = 0;  ///< NaN = not known
  std::size_t samples = 0;   ///< it was made of
};

struct BootstrapOptions {
  int resamples = 2000;
  double level = 0.95;  ///< share of the resamples that lie within the interval
  std::uint64_t seed = 0;
};

/// @brief Interval of a figure made of `count` independent things, by the percentiles of what
/// resamples of them give (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, section
/// 13.3). A function of the arguments alone, whatever the number of threads.
/// @param figure  what things of these indices, in [0, count), any of them more than once, come to
/// @return for no things all NaN; for one its own value and no bounds (NaN), as one thing does not
/// say how others would differ. Resamples that give NaN are left out.
/// Throws ps::Error when an option is unsound.
Interval bootstrap(std::size_t count,
                   const std::function<double(const std::vector<std::size_t>&)>& figure,
                   const BootstrapOptions& options = {});

/// @brief Interval of a mean. NaN among the values are left out: `samples` says how many remain.
/// @param groups  for each value, what it belongs to (its room, say), as values of one group are
/// alike: whole groups are drawn then. Empty, or all the same: each value by itself.
/// Throws ps::Error as bootstrap() does and when there are groups for more or fewer values.
Interval bootstrap_mean(const std::vector<double>& values, const std::vector<int>& groups = {},
                        const BootstrapOptions& options = {});

}  // namespace ps
