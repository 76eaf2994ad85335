// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/muted_colors.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libps/geometry/point.h"

namespace ps {
namespace {

/// Grey points, and some whose green is stronger by so many levels.
Cloud cloud_of(int grey, int colorful, int levels) {
  Cloud cloud;
  for (int i = 0; i < grey + colorful; ++i) {
    Point point;
    point.r = point.g = point.b = static_cast<std::uint8_t>(i % 156);
    if (i >= grey) point.g = static_cast<std::uint8_t>(point.g + levels);
    cloud.push_back(point);
  }
  return cloud;
}

TEST(MutedColors, limit_is_what_one_point_in_a_thousand_exceeds) {
  EXPECT_EQ(color_limit(cloud_of(0, 1000, 2)), 0) << "two levels are grey";
  EXPECT_NEAR(color_limit(cloud_of(0, 1000, 3)), 3 / 255., 1e-6);
  EXPECT_EQ(color_limit(cloud_of(9999, 9, 90)), 0) << "a few coloured pixels of a grey photo";
  EXPECT_GT(color_limit(cloud_of(9900, 100, 20)), 19 / 255.);
  EXPECT_EQ(color_limit(cloud_of(500, 500, 60)), 1) << "ordinary photos set none";
  EXPECT_EQ(color_limit(Cloud()), 1) << "nothing tells";
  EXPECT_NEAR(color_limit(cloud_of(100000, 900, 12)), 12 / 255., 1e-6) << "of many points, some";
}

TEST(MutedColors, stronger_colors_move_towards_their_luma) {
  Image image(1, 3);
  image(0, 0) = {1, 0, 0};
  image(0, 1) = {.25f, .5f, 1};
  image(0, 2) = {.5f, .55f, .5f};
  const Image grey = muted(image, 0), faded = muted(image, .2f);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(grey(0, 0)[c], .299, 1e-5);
    EXPECT_NEAR(grey(0, 1)[c], .299 * .25 + .587 * .5 + .114, 1e-5);
  }
  EXPECT_EQ(faded(0, 2), image(0, 2)) << "within the limit";
  const cv::Vec3f blue = faded(0, 1);
  EXPECT_NEAR(blue[2] - blue[0], .2, 1e-5);
  EXPECT_NEAR(.299 * blue[0] + .587 * blue[1] + .114 * blue[2], grey(0, 1)[0], 1e-5);
  EXPECT_LT(blue[0], blue[1]);
}

}  // namespace
}  // namespace ps
