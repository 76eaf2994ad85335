// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "libps/core/error.h"
#include "libps/eval/pairs.h"
#include "tests/support/box_world.h"
#include "tests/support/room_view.h"

namespace ps {
namespace {

/// Of the pixels whose surface is known, the share that is in the right mask.
double right(const Visibility& found, const Mask& seen, const Depth& depth) {
  const Mask known = depth > 0;
  const Mask right = (found.visible & seen) | (found.invisible & (1 - seen));
  return cv::countNonZero(right & known) / static_cast<double>(cv::countNonZero(known));
}

/// All but a pixel or two along the edges of things: the error halves with twice the pixels.
TEST(TrueVisibility, is_what_rays_say) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const rooms::Room room(seed);
    rooms::CameraOptions lens;
    lens.width = 240, lens.height = 180;
    const rooms::Camera a = rooms::random_camera(room, seed, lens);
    const rooms::Camera b = rooms::moved(room, a, seed, 0.6f, 0.8f);
    const View source = room_view(room, a);
    const View target = room_view(room, b);
    const std::vector<float> depth(target.depth.begin(), target.depth.end());
    std::vector<std::uint8_t> rays = rooms::seen_from(room, a, b, depth);
    const Mask seen(lens.height, lens.width, rays.data());
    const double exact = right(true_visibility(source, target), seen, target.depth);
    std::printf("  %.3f seen; right %.4f\n", cv::mean(seen)[0], exact);
    EXPECT_GT(exact, 0.97);
  }
}

TEST(TrueVisibility, of_a_view_by_itself_is_all_and_from_a_camera_turned_away_nothing) {
  const Intrinsics k = intrinsics_from_fov(40, 30, 70);
  const View view = box_world_view(k, pose_at(0, 0, -3, 0)),
             back = box_world_view(k, pose_at(0, 0, -3, M_PI));
  EXPECT_EQ(cv::countNonZero(true_visibility(view, view).visible), 1200);
  EXPECT_EQ(cv::countNonZero(true_visibility(view, view).invisible), 0);
  EXPECT_EQ(cv::countNonZero(true_visibility(back, view).visible), 0);
  EXPECT_EQ(cv::countNonZero(true_visibility(back, view).invisible), 1200);
}

TEST(TrueVisibility, has_pixels_of_unknown_depth_in_neither_mask) {
  const Intrinsics k = intrinsics_from_fov(40, 30, 70);
  View source = box_world_view(k, pose_at(0, 0, -3, 0)), target = source;
  target.depth(3, 5) = 0;
  target.depth(3, 6) = std::nanf("");
  source.depth(cv::Rect(10, 10, 5, 5)).setTo(-1);
  source.depth(20, 20) = INFINITY;  // its neighbours are known
  const Visibility found = true_visibility(source, target);
  EXPECT_EQ(found.visible(3, 5) + found.invisible(3, 5), 0);
  EXPECT_EQ(found.visible(3, 6) + found.invisible(3, 6), 0);
  EXPECT_EQ(found.visible(12, 12) + found.invisible(12, 12), 0);
  EXPECT_EQ(cv::countNonZero(found.invisible), 0);
}

TEST(TrueVisibility, takes_lenses_and_sizes_that_differ) {
  const View source = box_world_view(intrinsics_from_fov(160, 120, 90), pose_at(0, 0, -3, 0)),
             target = box_world_view({50, 70, 100, 90, 20, 40}, pose_at(0, 0, -3, 0));
  const Visibility found = true_visibility(source, target);
  EXPECT_EQ(found.visible.size(), target.depth.size());
  EXPECT_GT(cv::countNonZero(found.visible), 3400);
}

TEST(TrueVisibility, of_one_pixel_works_and_unsound_views_throw) {
  View one;
  one.intrinsics = intrinsics_from_fov(1, 1, 60);
  one.depth = Depth(1, 1, 2.f);
  EXPECT_EQ(true_visibility(one, one).visible(0, 0), 1);
  View cut = one;
  cut.depth = Depth(1, 2, 2.f);
  EXPECT_THROW(true_visibility(cut, one), Error);
  EXPECT_THROW(true_visibility(one, cut), Error);
  View blind = one;
  blind.depth.release();
  EXPECT_THROW(true_visibility(blind, one), Error);
  EXPECT_THROW(true_visibility(one, blind), Error);
  EXPECT_THROW(true_visibility(one, View()), Error);
}

}  // namespace
}  // namespace ps
