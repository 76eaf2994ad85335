// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/depth_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "libps/core/error.h"
#include "libps/eval/statistics.h"

namespace ps {
namespace {

void check_size(const char* where, const cv::Size& size, const cv::Size& expected,
                const char* what) {
  if (size == expected) return;
  throw Error(where,
              std::string(what) + " has " + std::to_string(size.width) + "x" +
                  std::to_string(size.height) + " pixels",
              std::to_string(expected.width) + "x" + std::to_string(expected.height));
}

bool known(float depth) { return std::isfinite(depth) && depth > 0; }

DepthErrors no_errors() {
  DepthErrors errors;
  errors.abs_rel = errors.median_rel = errors.rmse = errors.mean_abs =
      std::numeric_limits<double>::quiet_NaN();
  std::fill(std::begin(errors.delta), std::end(errors.delta), errors.abs_rel);
  return errors;
}

}  // namespace

DepthErrors depth_errors(const Depth& depth, const Depth& truth, const Mask& where) {
  check_size("depth_errors", truth.size(), depth.size(), "the true depth");
  if (!where.empty()) check_size("depth_errors", where.size(), depth.size(), "the mask");

  DepthErrors errors;
  std::vector<double> relative;
  double square = 0;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const double d = depth(y, x);
      const double t = truth(y, x);
      if (!known(depth(y, x)) || !known(truth(y, x))) continue;
      if (!where.empty() && where(y, x) == 0) continue;
      const double error = std::abs(d - t);
      const double ratio = std::max(d / t, t / d);
      relative.push_back(error / t);
      errors.abs_rel += error / t;
      errors.mean_abs += error;
      square += error * error;
      double bound = 1;
      for (double& share : errors.delta) share += ratio < (bound *= 1.25) ? 1 : 0;
    }
  }
  if (relative.empty()) return no_errors();

  errors.pixels = relative.size();
  const auto count = static_cast<double>(relative.size());
  errors.abs_rel /= count;
  errors.mean_abs /= count;
  errors.rmse = std::sqrt(square / count);
  for (double& share : errors.delta) share /= count;
  errors.median_rel = median(std::move(relative));
  return errors;
}

Depth median_scaled(const Depth& depth, const Depth& truth) {
  check_size("median_scaled", truth.size(), depth.size(), "the true depth");
  std::vector<double> ours, theirs;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      if (!known(depth(y, x)) || !known(truth(y, x))) continue;
      ours.push_back(depth(y, x));
      theirs.push_back(truth(y, x));
    }
  }
  if (ours.empty()) return depth.clone();
  return depth * (median(std::move(theirs)) / median(std::move(ours)));
}

}  // namespace ps
