// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/nearest_seen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ps::outpaint {
namespace {

TEST(NearestSeen, is_as_near_as_the_nearest_but_for_the_chamfers_error) {
  cv::RNG random(4);
  cv::Mat1b missing(40, 56);
  for (std::uint8_t& m : missing) m = random.uniform(0, 50) ? 7 : 0;
  const cv::Mat1i nearest = nearest_seen(missing);
  ASSERT_EQ(nearest.size(), missing.size());
  for (int y = 0; y < missing.rows; ++y) {
    for (int x = 0; x < missing.cols; ++x) {
      const int row = nearest(y, x) / missing.cols, column = nearest(y, x) % missing.cols;
      ASSERT_EQ(missing(row, column), 0);
      double least = std::numeric_limits<double>::max();
      for (int v = 0; v < missing.rows; ++v) {
        for (int u = 0; u < missing.cols; ++u) {
          if (missing(v, u) == 0) least = std::min(least, std::hypot(v - y, u - x));
        }
      }
      EXPECT_LE(std::hypot(row - y, column - x), 1.05 * least) << y << ' ' << x;
    }
  }
}

TEST(NearestSeen, is_empty_where_all_is_missing) {
  EXPECT_TRUE(nearest_seen(cv::Mat1b(8, 8, std::uint8_t{1})).empty());
}

TEST(NearestSeen, is_each_pixel_itself_where_nothing_is_missing) {
  const cv::Mat1i nearest = nearest_seen(cv::Mat1b::zeros(3, 5));
  for (int i = 0; i < 15; ++i) EXPECT_EQ(nearest(i / 5, i % 5), i);
}

TEST(WithNearestColors, are_those_of_a_pixel_that_is_nearest_or_as_near_as_the_chamfer_tells) {
  cv::RNG random(5);
  cv::Mat1b missing(12, 17);
  for (std::uint8_t& m : missing) m = random.uniform(0, 3) ? 1 : 0;
  nn::Tensor image({1, missing.rows, missing.cols, 3});
  for (int i = 0; i < missing.size().area() * 3; ++i) image.data()[i] = static_cast<float>(i);
  const nn::Tensor whole = with_nearest_colors(image.view(), missing);
  for (int y = 0; y < missing.rows; ++y) {
    for (int x = 0; x < missing.cols; ++x) {
      const float* const color = whole.view().pixel(0, y, x);
      const int from = static_cast<int>(color[0]) / 3;  // red tells where a colour is from
      EXPECT_EQ(color[1], static_cast<float>(3 * from + 1));
      EXPECT_EQ(color[2], static_cast<float>(3 * from + 2));
      ASSERT_EQ(missing(from / missing.cols, from % missing.cols), 0);
      double least = std::numeric_limits<double>::max();
      for (int v = 0; v < missing.rows; ++v) {
        for (int u = 0; u < missing.cols; ++u) {
          if (missing(v, u) == 0) least = std::min(least, std::hypot(v - y, u - x));
        }
      }
      EXPECT_LE(std::hypot(from / missing.cols - y, from % missing.cols - x), 1.05 * least);
    }
  }
}

TEST(WithNearestColors, leave_a_picture_that_is_all_missing_as_it_is) {
  nn::Tensor image({1, 2, 3, 3});
  for (int i = 0; i < 18; ++i) image.data()[i] = static_cast<float>(i);
  const nn::Tensor whole = with_nearest_colors(image.view(), cv::Mat1b(2, 3, std::uint8_t{1}));
  for (int i = 0; i < 18; ++i) EXPECT_EQ(whole.data()[i], static_cast<float>(i));
}

}  // namespace
}  // namespace ps::outpaint
