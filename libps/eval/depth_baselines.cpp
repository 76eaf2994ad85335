// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/depth_baselines.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "libps/core/error.h"
#include "libps/eval/statistics.h"

namespace ps {
namespace {

bool known(float depth) { return std::isfinite(depth) && depth > 0; }

}  // namespace

void DepthBaselines::learn(const Depth& truth) {
  std::vector<double> depths;
  for (const float depth : truth) {
    if (known(depth)) depths.push_back(depth);
  }
  if (depths.empty()) return;
  const double middle = median(std::move(depths));
  medians_.push_back(middle);
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

}  // namespace ps
