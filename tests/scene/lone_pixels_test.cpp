// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/lone_pixels.h"

#include <gtest/gtest.h>

namespace ps {
namespace {

TEST(LonePixels, are_those_that_no_neighbour_shares) {
  Depth depth(20, 20, 2.f);
  depth.colRange(10, 20) = 4;  // an edge
  depth.row(5) = 1;            // a line
  depth(12, 4) = 3;
  depth(13, 5) = 5;
  depth(15, 15) = 0;
  const Mask lone = lone_pixels(depth);
  EXPECT_EQ(cv::countNonZero(lone), 2);
  EXPECT_TRUE(lone(12, 4) && lone(13, 5));
}

TEST(LonePixels, are_not_found_in_empty_or_sparse_depth) {
  EXPECT_EQ(cv::countNonZero(lone_pixels(Depth::zeros(5, 5))), 0);
  Depth sparse = Depth::zeros(9, 9);
  sparse(4, 4) = 1;
  sparse(4, 5) = 2;
  EXPECT_EQ(cv::countNonZero(lone_pixels(sparse)), 0);
  sparse(5, 4) = sparse(5, 5) = 4;  // now each has three known neighbours
  EXPECT_TRUE(lone_pixels(sparse)(4, 4) && lone_pixels(sparse)(4, 5));
  EXPECT_TRUE(lone_pixels(Depth()).empty());
}

}  // namespace
}  // namespace ps
