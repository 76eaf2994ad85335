// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/overlap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libps/geometry/lift.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

TEST(SurfaceDepth, is_exact_between_the_pixels_of_a_plane) {
  // 1/z is linear in the pixel on every plane.
  const auto depth_at = [](double u, double v) { return 1 / (0.3 + 0.002 * u - 0.001 * v); };
  Depth depth(30, 40);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) depth(y, x) = static_cast<float>(depth_at(x, y));
  }
  const Mask all(depth.size(), 1);
  for (double v = 0; v <= 29; v += 0.37) {
    for (double u = 0; u <= 39; u += 0.41) {
      EXPECT_NEAR(surface_depth(depth, all, u, v) / depth_at(u, v), 1, 1e-6) << u << " " << v;
    }
  }
}

TEST(SurfaceDepth, is_none_beside_the_image_at_an_edge_and_where_a_pixel_is_not_usable) {
  Depth depth(4, 6, 2.f);
  depth.col(5) = 3;
  Mask usable(depth.size(), 1);
  usable(2, 1) = 0;
  EXPECT_EQ(surface_depth(depth, usable, -0.6, 1), 0);
  EXPECT_EQ(surface_depth(depth, usable, 2, 3.6), 0);
  EXPECT_EQ(surface_depth(depth, usable, std::nan(""), 1), 0);
  EXPECT_EQ(surface_depth(depth, usable, 4.5, 1), 0);
  EXPECT_EQ(surface_depth(depth, usable, 1.2, 1.5), 0);
  EXPECT_FLOAT_EQ(surface_depth(depth, usable, 2, 2), 2);
  EXPECT_FLOAT_EQ(surface_depth(depth, usable, -0.4, -0.4), 2);
  EXPECT_FLOAT_EQ(surface_depth(depth, usable, 5, 1), 3);
  EXPECT_FLOAT_EQ(surface_depth(Depth(1, 1, 7.f), Mask(1, 1, 1), 0.2, -0.3), 7);
}

TEST(DepthRatios, of_two_views_of_one_world_are_0_but_for_hidden_places) {
  const Intrinsics lens{160, 120, 130, 130, 79.5, 59.5};
  const View a = box_world_view(lens, pose_at(0, 0, -2, 0));
  View b = box_world_view(lens, pose_at(0.3, 0, -1.8, 0.2));
  std::size_t agree = 0;
  const std::vector<DepthRatio> ratios = depth_ratios(a, b);
  for (const DepthRatio& r : ratios) agree += std::abs(r.log_ratio) < 2e-3;
  EXPECT_GT(ratios.size(), 5000u);
  EXPECT_GT(static_cast<double>(agree), 0.9 * static_cast<double>(ratios.size()));
  b.depth *= 0.5f;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    EXPECT_NEAR(depth_ratios(a, b)[i].log_ratio, ratios[i].log_ratio + std::log(2.), 1e-5);
    if (i == 20) break;
  }
}

TEST(DepthRatios, are_few_when_few_are_asked_for_and_none_without_depth) {
  const Intrinsics lens{160, 120, 130, 130, 79.5, 59.5};
  View a = box_world_view(lens, pose_at(0, 0, -2, 0));
  const View b = a;
  EXPECT_LT(depth_ratios(a, b, 100).size(), 200u);
  EXPECT_GT(depth_ratios(a, b, 100).size(), 20u);
  a.depth = a.depth.clone();
  a.depth = 0;
  EXPECT_TRUE(depth_ratios(a, b).empty());
  a.depth = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(depth_ratios(a, b).empty());
}

}  // namespace
}  // namespace ps
