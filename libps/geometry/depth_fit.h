// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: a robust line through logarithms of depths.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace ps {

/// @return the middle one of `values`, the upper of two; reorders them; not empty
float median(std::vector<float>& values);

/// log depth = exponent * log estimate + log_scale.
struct DepthFit {
  double exponent = 1;
  double log_scale = 0;
  double spread = 0;  ///< standard deviation of the residuals, from their median

  float operator()(float log_estimate) const {
    return static_cast<float>(exponent * log_estimate + log_scale);
  }
};

/// @brief Fits the line by iterated reweighting with Tukey's biweight, from the least median of
/// absolute residuals over some exponents: nearly half of the weight may be outliers.
/// @param weight  how much a pixel counts; where it is more than 0 both logarithms are finite
/// @param exponents  the least and the greatest allowed; 1 lies between
///
/// The exponent is the ratio of standard deviations (the reduced major axis). By least squares
/// each error of the estimate would draw it to 0, and networks' errors are large. Where estimates
/// differ by little more than their errors, it is held near 1. The same bytes for any number of
/// threads. At least one weight is more than 0.
DepthFit fit_log_depth(const cv::Mat1f& log_estimate, const cv::Mat1f& log_depth,
                       const cv::Mat1f& weight, cv::Vec2d exponents);

}  // namespace ps
