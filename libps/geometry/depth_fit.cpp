// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/depth_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "libps/core/random.h"

namespace ps {
namespace {

constexpr std::size_t kDraws = 8192;
constexpr std::size_t kStartDraws = 1024;
constexpr int kStartExponents = 24;
constexpr int kMostRounds = 40;
constexpr double kDeviations = 1.4826;  ///< of a normal, in medians of absolute residuals
constexpr double kBiweight = 4.685;     ///< 95 % as efficient as least squares on normal errors
constexpr double kLeastSpread = 1e-6;   ///< of logarithms in single precision
constexpr double kHold = 2;  ///< so many variances of the errors speak for an exponent of 1

struct Samples {
  std::vector<float> x, y;  ///< logarithms of estimate and depth
};

/// Draws pixels as often as their weights say, so that from here on all count the same: one from
/// each of so many equal parts of the sum of weights, at random in it, as a fixed step would meet
/// the same columns in each row.
Samples drawn(const cv::Mat1f& log_estimate, const cv::Mat1f& log_depth, const cv::Mat1f& weight) {
  double total = 0;
  for (const float w : weight) total += w;
  Samples samples;
  samples.x.reserve(kDraws);
  samples.y.reserve(kDraws);
  std::uint32_t k = 0;
  const auto place = [&] { return (k + random_unit(0, {k, 0, 0, 0})) * (total / kDraws); };
  double passed = 0, next = place();
  int last_x = 0, last_y = 0;
  const auto take = [&](int x, int y) {
    samples.x.push_back(log_estimate(y, x));
    samples.y.push_back(log_depth(y, x));
    next = ++k < kDraws ? place() : std::numeric_limits<double>::infinity();
  };
  for (int y = 0; y < weight.rows; ++y) {
    for (int x = 0; x < weight.cols; ++x) {
      if (!(weight(y, x) > 0)) continue;
      passed += weight(y, x);
      while (next < passed) take(x, y);
      last_x = x, last_y = y;
    }
  }
  while (k < kDraws) take(last_x, last_y);  // rounding may leave the last one
  return samples;
}

/// The median of |residual|, over each `step`-th sample.
double median_residual(const Samples& samples, const DepthFit& fit, std::size_t step) {
  std::vector<float> size;
  for (std::size_t i = 0; i < samples.x.size(); i += step) {
    size.push_back(std::fabs(samples.y[i] - fit(samples.x[i])));
  }
  return median(size);
}

DepthFit start_of(const Samples& samples, cv::Vec2d exponents) {
  constexpr std::size_t kStep = kDraws / kStartDraws;
  DepthFit best;
  double least = std::numeric_limits<double>::infinity();
  for (int e = 0; e <= kStartExponents; ++e) {
    DepthFit fit;
    const double part = static_cast<double>(e) / kStartExponents;
    fit.exponent = exponents[0] * std::pow(exponents[1] / exponents[0], part);
    std::vector<float> left;
    for (std::size_t i = 0; i < samples.x.size(); i += kStep) {
      left.push_back(samples.y[i] - fit(samples.x[i]));
    }
    fit.log_scale = median(left);
    // An error of the estimate becomes smaller by a smaller exponent, not more right.
    const double size = median_residual(samples, fit, kStep) / fit.exponent;
    if (size < least) least = size, best = fit;
  }
  return best;
}

/// One round of reweighting.
DepthFit refitted(const Samples& samples, const DepthFit& fit, cv::Vec2d exponents) {
  const double spread = std::max(fit.spread, kLeastSpread);
  // From one of them, so that the variance of equal ones is 0 exactly.
  const double x0 = samples.x.front(), y0 = samples.y.front();
  double sum = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_yy = 0;
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    const double x = samples.x[i] - x0, y = samples.y[i] - y0;
    const double r = (samples.y[i] - fit(samples.x[i])) / (kBiweight * spread);
    if (std::fabs(r) >= 1) continue;
    const double w = (1 - r * r) * (1 - r * r);
    sum += w, sum_x += w * x, sum_y += w * y, sum_xx += w * x * x, sum_yy += w * y * y;
  }
  const double x = sum_x / sum, y = sum_y / sum;
  const double hold = kHold * spread * spread / (fit.exponent * fit.exponent);
  DepthFit next;
  next.exponent = std::sqrt((sum_yy / sum - y * y + hold) / (sum_xx / sum - x * x + hold));
  next.exponent = std::clamp(next.exponent, exponents[0], exponents[1]);
  next.log_scale = y + y0 - next.exponent * (x + x0);
  next.spread = kDeviations * median_residual(samples, next, 1);
  return next;
}

}  // namespace

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

DepthFit fit_log_depth(const cv::Mat1f& log_estimate, const cv::Mat1f& log_depth,
                       const cv::Mat1f& weight, cv::Vec2d exponents) {
  const Samples samples = drawn(log_estimate, log_depth, weight);
  DepthFit fit = start_of(samples, exponents);
  fit.spread = kDeviations * median_residual(samples, fit, 1);
  for (int round = 0; round < kMostRounds; ++round) {
    const DepthFit next = refitted(samples, fit, exponents);
    const double change =
        std::fabs(next.exponent - fit.exponent) + std::fabs(next.log_scale - fit.log_scale);
    fit = next;
    if (change < 1e-5) break;
  }
  return fit;
}

}  // namespace ps
