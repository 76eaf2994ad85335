// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/greys.h"

#include <gtest/gtest.h>

#include "libps/geometry/point.h"

namespace ps {
namespace {

Cloud cloud_of(int red, int green, int blue) {
  Cloud cloud;
  Point point;
  point.r = point.g = point.b = 80;
  cloud.push_back(point);
  point.r = static_cast<std::uint8_t>(red);
  point.g = static_cast<std::uint8_t>(green);
  point.b = static_cast<std::uint8_t>(blue);
  cloud.push_back(point);
  return cloud;
}

TEST(Greys, two_levels_are_grey_and_three_are_a_colour) {
  EXPECT_TRUE(is_grey(cloud_of(10, 12, 11)));
  EXPECT_FALSE(is_grey(cloud_of(10, 13, 11)));
  EXPECT_FALSE(is_grey(cloud_of(253, 255, 251)));
  EXPECT_FALSE(is_grey(Cloud())) << "nothing tells";
}

TEST(Greys, grey_of_a_picture_is_its_luma) {
  Image image(1, 2);
  image(0, 0) = {1, 0, 0};
  image(0, 1) = {.25f, .5f, 1};
  const Image grey = grey_of(image);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(grey(0, 0)[c], .299, 1e-5);
    EXPECT_NEAR(grey(0, 1)[c], .299 * .25 + .587 * .5 + .114, 1e-5);
  }
}

}  // namespace
}  // namespace ps
