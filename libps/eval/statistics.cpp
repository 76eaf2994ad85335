// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"

namespace ps {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kPurpose = 0x626f6f74;  ///< of the random numbers

void check(const BootstrapOptions& o) {
  if (o.resamples < 1) {
    throw Error("bootstrap", std::to_string(o.resamples) + " resamples", "at least one");
  }
  if (!(o.level > 0 && o.level < 1)) {
    throw Error("bootstrap", "a level of " + std::to_string(o.level), "more than 0, less than 1");
  }
}

/// @return what resamples give, in order; without NaN
std::vector<double> resampled(std::size_t count,
                              const std::function<double(const std::vector<std::size_t>&)>& figure,
                              const BootstrapOptions& o) {
  std::vector<double> figures(static_cast<std::size_t>(o.resamples));
  parallel_for(figures.size(), [&](std::size_t r) {
    std::vector<std::size_t> drawn(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double at = random_unit(
          o.seed, {static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(i), kPurpose, 0});
      drawn[i] = static_cast<std::size_t>(at * static_cast<double>(count));
    }
    figures[r] = figure(drawn);
  });
  figures.erase(
      std::remove_if(figures.begin(), figures.end(), [](double f) { return std::isnan(f); }),
      figures.end());
  std::sort(figures.begin(), figures.end());
  return figures;
}

/// Sum and number of the values of one group.
struct Sum {
  double sum = 0;
  std::size_t count = 0;
};

std::vector<Sum> sums_of(const std::vector<double>& values, const std::vector<int>& groups) {
  std::map<int, Sum> by_group;
  std::vector<Sum> each;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    each.push_back({values[i], 1});
    if (groups.empty()) continue;
    Sum& group = by_group[groups[i]];
    group.sum += values[i];
    ++group.count;
  }
  if (by_group.size() < 2) return each;
  std::vector<Sum> sums;
  for (const auto& [group, sum] : by_group) sums.push_back(sum);
  return sums;
}

}  // namespace

double mean(const std::vector<double>& values) {
  if (values.empty()) return kNan;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
  if (values.empty()) return kNan;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

Interval bootstrap(std::size_t count,
                   const std::function<double(const std::vector<std::size_t>&)>& figure,
                   const BootstrapOptions& options) {
  check(options);
  if (count == 0) return {kNan, kNan, kNan, 0};
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  Interval interval = {figure(all), kNan, kNan, count};
  if (count == 1) return interval;
  const std::vector<double> figures = resampled(count, figure, options);
  if (figures.empty()) return interval;
  // No interpolation between neighbours: they may be infinite.
  const double tail = (1 - options.level) / 2, last = static_cast<double>(figures.size() - 1);
  interval.low = figures[static_cast<std::size_t>(std::floor(tail * last))];
  interval.high = figures[static_cast<std::size_t>(std::ceil((1 - tail) * last))];
  return interval;
}

Interval bootstrap_mean(const std::vector<double>& values, const std::vector<int>& groups,
                        const BootstrapOptions& options) {
  if (!groups.empty() && groups.size() != values.size()) {
    throw Error("bootstrap_mean", "groups of " + std::to_string(groups.size()) + " values",
                "of " + std::to_string(values.size()));
  }
  const std::vector<Sum> sums = sums_of(values, groups);
  const auto figure = [&](const std::vector<std::size_t>& drawn) {
    Sum all;
    for (const std::size_t i : drawn) {
      all.sum += sums[i].sum;
      all.count += sums[i].count;
    }
    return all.sum / static_cast<double>(all.count);
  };
  Interval interval = bootstrap(sums.size(), figure, options);
  interval.samples = 0;
  for (const Sum& sum : sums) interval.samples += sum.count;
  return interval;
}

}  // namespace ps
