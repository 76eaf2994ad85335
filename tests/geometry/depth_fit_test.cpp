// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/depth_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libps/core/random.h"

namespace ps {
namespace {

struct Logs {
  cv::Mat1f estimate, depth, weight;
};

/// depth = 1.3 * estimate + 0.4, and noise; `outliers` of them lie up to 1.5 farther.
Logs logs_of(cv::Size size, double noise, double outliers, std::uint64_t seed) {
  Logs logs{cv::Mat1f(size), cv::Mat1f(size), cv::Mat1f(size, 1.f)};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto at = [&](std::uint32_t what) {
        return std::array<std::uint32_t, 4>{static_cast<std::uint32_t>(x),
                                            static_cast<std::uint32_t>(y), what, 0};
      };
      const double e = 2 * random_unit(seed, at(0)) - 0.5;
      double d = 1.3 * e + 0.4 + noise * random_normal(seed, at(1))[0];
      if (random_unit(seed, at(2)) < outliers) d += 1.5 * random_unit(seed, at(3));
      logs.estimate(y, x) = static_cast<float>(e);
      logs.depth(y, x) = static_cast<float>(d);
    }
  }
  return logs;
}

DepthFit fit_of(const Logs& logs, cv::Vec2d exponents = {0.5, 2}) {
  return fit_log_depth(logs.estimate, logs.depth, logs.weight, exponents);
}

TEST(DepthFit, forty_percent_of_outliers_on_one_side_do_not_move_the_line) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const DepthFit fit = fit_of(logs_of({160, 120}, 0.01, 0.4, seed));
    EXPECT_NEAR(fit.exponent, 1.3, 0.01);
    EXPECT_NEAR(fit.log_scale, 0.4, 0.01);
  }
}

TEST(DepthFit, finds_how_much_residuals_spread) {
  EXPECT_NEAR(fit_of(logs_of({160, 120}, 0.05, 0, 1)).spread, 0.05, 0.002);
}

TEST(DepthFit, weights_count) {
  Logs logs = logs_of({100, 90}, 0, 0, 2);
  logs.depth.rowRange(0, 70) += 0.5f;  // most say this,
  logs.weight.rowRange(0, 70) = 0.1f;  // but it weighs little
  EXPECT_NEAR(fit_of(logs).log_scale, 0.4, 1e-4);
  logs.weight.rowRange(0, 70) = 0.f;
  logs.estimate.rowRange(0, 70) = NAN;
  EXPECT_NEAR(fit_of(logs).log_scale, 0.4, 1e-4);
}

TEST(DepthFit, an_exponent_stays_within_its_limits) {
  EXPECT_EQ(fit_of(logs_of({40, 30}, 0.01, 0, 3), {0.5, 1.2}).exponent, 1.2);
}

TEST(DepthFit, errors_of_the_estimate_do_not_draw_the_exponent_to_0) {
  Logs logs = logs_of({160, 120}, 0, 0, 4);
  for (int i = 0; i < 160 * 120; ++i) {
    const auto at = static_cast<std::uint32_t>(i);
    logs.estimate(i / 160, i % 160) +=
        static_cast<float>(0.58 * random_normal(6, {at, 0, 0, 0})[0]);
  }
  EXPECT_NEAR(fit_of(logs).exponent, 1, 0.15);  // by least squares 0.65, as errors are half of all
}

TEST(DepthFit, an_exponent_that_cannot_be_told_is_near_1) {
  Logs logs = logs_of({160, 120}, 0.1, 0, 4);
  logs.estimate *= 1e-3;  // all the same, but for what is too little to tell
  EXPECT_NEAR(fit_of(logs).exponent, 1, 0.25);
  logs = logs_of({160, 120}, 0, 0, 4);
  logs.depth = 0.3f;  // the same, and estimates are noise
  EXPECT_NEAR(fit_of(logs).exponent, 1, 0.25);
  logs.estimate = 0.3f;
  EXPECT_EQ(fit_of(logs).exponent, 1);
}

TEST(DepthFit, one_pixel_gives_the_scale) {
  const DepthFit fit =
      fit_log_depth(cv::Mat1f(1, 1, 2.f), cv::Mat1f(1, 1, 5.f), cv::Mat1f(1, 1, 1.f), {0.5, 2});
  EXPECT_EQ(fit.exponent, 1);
  EXPECT_NEAR(fit.log_scale, 3, 1e-6);
}

}  // namespace
}  // namespace ps
