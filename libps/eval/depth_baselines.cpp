// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/depth_baselines.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "libps/core/error.h"
#include "libps/eval/statistics.h"

namespace ps {
namespace {

bool known(float depth) { return std::isfinite(depth) && depth > 0; }

/// The mean logarithm of known depths, and whether there are any.
std::pair<double, bool> mean_log(const Depth& depths) {
  double sum = 0, count = 0;
  for (const float depth : depths) {
    if (!known(depth)) continue;
    sum += std::log(depth);
    ++count;
  }
  return {count > 0 ? sum / count : 0, count > 0};
}

}  // namespace

/// Pixels of the bin along a side; of a side shorter than the bins, one that others have too.
cv::Range DepthBaselines::part(int bin, int side) {
  const int begin = bin * side / kBins;
  return {begin, std::max(begin + 1, (bin + 1) * side / kBins)};
}

DepthBaselines::Logs DepthBaselines::logs_of(const Depth& truth) {
  Logs logs;
  for (int row = 0; row < kBins; ++row) {
    for (int column = 0; column < kBins; ++column) {
      const auto [mean, any] = mean_log(truth(part(row, truth.rows), part(column, truth.cols)));
      logs.sum(row, column) = mean;
      logs.count(row, column) = any ? 1 : 0;
    }
  }
  return logs;
}

void DepthBaselines::learn(const Depth& truth) {
  std::vector<double> depths;
  for (const float depth : truth) {
    if (known(depth)) depths.push_back(depth);
  }
  if (depths.empty()) return;
  const double middle = median(std::move(depths));
  medians_.push_back(middle);
  const Logs logs = logs_of(truth);
  logs_.sum += logs.sum;
  logs_.count += logs.count;
  for (int y = 0; y < truth.rows; ++y) {
    const auto bin = static_cast<std::size_t>(y * kBins / truth.rows);
    for (int x = 0; x < truth.cols; ++x) {
      if (!known(truth(y, x))) continue;
      log_sum_[bin] += std::log(truth(y, x) / middle);
      ++count_[bin];
    }
  }
}

Depth DepthBaselines::constant(cv::Size size) const {
  if (medians_.empty()) throw Error("depth baselines", "have seen no depth", "learn() before");
  return {size, static_cast<float>(median(medians_))};
}

Depth DepthBaselines::ramp(cv::Size size) const {
  Depth column(kBins, 1), ramp;
  for (int bin = 0; bin < kBins; ++bin) {
    const auto i = static_cast<std::size_t>(bin);
    // Images of fewer rows than bins leave some out; these are as the one above.
    column(bin) = count_[i] > 0 ? static_cast<float>(std::exp(log_sum_[i] / count_[i]))
                  : bin > 0     ? column(bin - 1)
                                : 1;
  }
  cv::resize(column, ramp, size, 0, 0, cv::INTER_LINEAR);
  return constant(size).mul(ramp);
}

Depth DepthBaselines::mean(const Depth& truth) const {
  const double otherwise = std::log(constant({1, 1})(0, 0));
  if (truth.empty()) return {};
  const Logs own = logs_of(truth);
  Depth grid(kBins, kBins), mean;
  for (int y = 0; y < kBins; ++y) {
    for (int x = 0; x < kBins; ++x) {
      const double count = logs_.count(y, x) - own.count(y, x);
      const double sum = logs_.sum(y, x) - own.sum(y, x);
      grid(y, x) = static_cast<float>(std::exp(count > 0 ? sum / count : otherwise));
    }
  }
  cv::resize(grid, mean, truth.size(), 0, 0, cv::INTER_LINEAR);
  return mean;
}

}  // namespace ps
