// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/consistency.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/image_metrics.h"
#include "libps/models/lpips.h"
#include "tests/support/box_world.h"
#include "tests/support/random_weights.h"
#include "tests/support/room_view.h"

namespace ps {
namespace {

constexpr double kDegree = M_PI / 180;

/// Colours are linear in the pixel's place, so that bilinear resampling is exact.
View linear_view(const Intrinsics& k, const Pose& pose) {
  View view;
  view.intrinsics = k;
  view.world_from_cam = pose;
  view.color.create(k.height, k.width);
  for (int y = 0; y < k.height; ++y) {
    for (int x = 0; x < k.width; ++x) {
      view.color(y, x) = {static_cast<float>(x) / 100, static_cast<float>(y) / 100, 0.25f};
    }
  }
  return view;
}

TEST(WarpRotation, is_exact_for_any_two_lenses) {
  const Intrinsics from = {60, 40, 50, 55, 31.3, 17.8}, to = {33, 57, 41, 37, 12.5, 30.1};
  const Pose a = pose_at(1, 2, 3, 0.3, -0.2), b = pose_at(1, 2, 3, 0.7, 0.1);
  const Warp warp = warp_rotation(linear_view(from, a), to, b);
  ASSERT_EQ(warp.color.size(), cv::Size(33, 57));
  int valid = 0;
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      // Through a point far away, in the world.
      const Eigen::Vector3d seen = a.inverse() * (b * to.lift(x, y, 7));
      const Eigen::Vector2d at = from.project(seen);
      const bool inside =
          seen.z() > 0 && at.x() >= 0 && at.y() >= 0 && at.x() <= 59 && at.y() <= 39;
      ASSERT_EQ(warp.valid(y, x), inside) << x << " " << y;
      const cv::Vec3f expected = inside ? cv::Vec3f(static_cast<float>(at.x() / 100),
                                                    static_cast<float>(at.y() / 100), 0.25f)
                                        : cv::Vec3f(0, 0, 0);
      EXPECT_LT(cv::norm(warp.color(y, x) - expected), 1e-6);
      valid += inside;
    }
  }
  EXPECT_GT(valid, 300);
  EXPECT_LT(valid, 33 * 57 - 300);
}

TEST(WarpRotation, into_the_same_camera_changes_nothing) {
  for (const cv::Size size : {cv::Size(1, 1), {1, 9}, {31, 20}}) {
    const Intrinsics k = intrinsics_from_fov(size.width, size.height, 77);
    const Pose pose = pose_at(0.1, -0.7, 2, 1.1, 0.4);
    const View view = linear_view(k, pose);
    const Warp warp = warp_rotation(view, k, pose);
    EXPECT_EQ(cv::countNonZero(warp.valid), size.area());
    EXPECT_LT(cv::norm(warp.color, view.color, cv::NORM_INF), 1e-6);
  }
}

TEST(WarpRotation, of_a_camera_that_looks_away_shows_nothing_of_what_is_behind_it) {
  const Intrinsics k = intrinsics_from_fov(30, 30, 90);
  const Warp warp = warp_rotation(linear_view(k, pose_at(0, 0, 0, 0)), k, pose_at(0, 0, 0, M_PI));
  EXPECT_EQ(cv::countNonZero(warp.valid), 0);
}

/// A room from one place, the second view turned to the right and up.
struct TurnedRoom {
  View first, second;
  TurnedRoom(std::uint64_t seed, double right, double up, int side = 128) {
    const rooms::Room room(seed);
    rooms::CameraOptions lens;
    lens.width = lens.height = side;
    lens.min_fov = lens.max_fov = 90;
    const rooms::Camera camera = rooms::random_camera(room, seed, lens);
    first = taken(room, camera);
    second = taken(room, turned(camera, right, up));
  }

  /// Each pixel is the mean of a square, as a sensor's is: a ray for each alone would alias.
  static View taken(const rooms::Room& room, rooms::Camera camera) {
    constexpr int kFiner = 4;
    const int width = camera.width, height = camera.height;
    camera.width *= kFiner, camera.height *= kFiner;
    camera.fx *= kFiner, camera.fy *= kFiner;
    camera.cx = (camera.cx + 0.5f) * kFiner - 0.5f, camera.cy = (camera.cy + 0.5f) * kFiner - 0.5f;
    View view = room_view(room, camera);
    cv::resize(view.color, view.color, {width, height}, 0, 0, cv::INTER_AREA);
    view.intrinsics = resized(view.intrinsics, width, height);
    return view;
  }
};

/// Away from the boxes, whose edges alias.
TEST(Consistency, of_smooth_walls_is_above_60_dB) {
  const Intrinsics k = intrinsics_from_fov(128, 96, 80);
  const View a = box_world_view(k, pose_at(0, 0, 0, M_PI)),
             b = box_world_view(k, pose_at(0, 0, 0, M_PI - 0.5, 0.2));
  const ConsistencyScore score = consistency(a, b);
  std::printf("  %.2f dB\n", score.psnr);
  EXPECT_GT(score.psnr, 60);
}

/// 34 to 37 dB is what resampling leaves of these rooms' fine texture at this size.
TEST(Consistency, of_ray_cast_rooms_is_high_and_falls_with_a_pixel_s_error_and_with_another_room) {
  for (const std::uint64_t seed : {0u, 3u, 4u}) {
    const TurnedRoom room(seed, 17.5 * kDegree, 0);
    const double exact = consistency(room.first, room.second).psnr;
    View off = room.second;
    off.world_from_cam.rotate(Eigen::AngleAxisd(1 / off.intrinsics.fx, Eigen::Vector3d::UnitY()));
    const double by_a_pixel = consistency(room.first, off).psnr;
    TurnedRoom other(seed + 100, 0, 0);
    other.first.world_from_cam = room.second.world_from_cam;
    const double unrelated = consistency(room.first, other.first).psnr;
    std::printf("  %.2f dB, a pixel off %.2f dB, another room %.2f dB\n", exact, by_a_pixel,
                unrelated);
    EXPECT_GT(exact, 33.5);
    EXPECT_LT(by_a_pixel, exact - 5);
    EXPECT_LT(unrelated, 15);
  }
}

TEST(Consistency, is_the_mean_of_both_ways_and_these_differ) {
  const TurnedRoom room(3, 30 * kDegree, 5 * kDegree, 64);
  const View &a = room.first, &b = room.second;
  const Warp there = warp_rotation(a, b.intrinsics, b.world_from_cam);
  const Warp back = warp_rotation(b, a.intrinsics, a.world_from_cam);
  const double one = psnr(there.color, b.color, there.valid);
  const double other = psnr(back.color, a.color, back.valid);
  EXPECT_NE(one, other);
  const ConsistencyScore score = consistency(a, b);
  EXPECT_DOUBLE_EQ(score.psnr, (one + other) / 2);
  EXPECT_DOUBLE_EQ(score.overlap, (cv::mean(there.valid)[0] + cv::mean(back.valid)[0]) / 2);
  EXPECT_EQ(consistency(b, a).psnr, score.psnr);
}

TEST(Consistency, shows_the_perceptual_distance_images_that_are_black_outside_the_overlap) {
  const TurnedRoom room(3, 30 * kDegree, 0, 64);
  int calls = 0;
  const auto distance = [&](const Image& warped, const Image& image) {
    const View& source = calls == 0 ? room.first : room.second;
    const View& target = calls == 0 ? room.second : room.first;
    const Warp warp = warp_rotation(source, target.intrinsics, target.world_from_cam);
    for (int i = 0; i < 64 * 64; ++i) {
      const bool valid = warp.valid(i / 64, i % 64) != 0;
      const cv::Vec3f black(0, 0, 0);
      EXPECT_EQ(image(i / 64, i % 64), valid ? target.color(i / 64, i % 64) : black);
      EXPECT_EQ(warped(i / 64, i % 64), valid ? warp.color(i / 64, i % 64) : black);
    }
    return calls++ == 0 ? 0.25 : 0.75;
  };
  EXPECT_EQ(consistency(room.first, room.second, distance).perceptual, 0.5);
  EXPECT_EQ(calls, 2);
}

TEST(Consistency, measures_lpips) {
  const models::Lpips net(models::random_lpips(8));
  const TurnedRoom room(3, 20 * kDegree, 0, 64);
  View grey = room.second;
  grey.color = Image(grey.color.size(), cv::Vec3f(0.5f, 0.5f, 0.5f));
  const PerceptualDistance distance = lpips_distance(net);
  EXPECT_EQ(distance(grey.color, grey.color), 0);
  const double turned = consistency(room.first, room.second, distance).perceptual;
  EXPECT_GT(turned, 0);
  EXPECT_LT(turned, consistency(room.first, grey, distance).perceptual);
}

TEST(Consistency, without_overlap_is_nan) {
  const Intrinsics k = intrinsics_from_fov(32, 24, 60);
  const View a = linear_view(k, pose_at(0, 0, 0, 0)), b = linear_view(k, pose_at(0, 0, 0, 1.8));
  const ConsistencyScore score = consistency(a, b, [](const Image&, const Image&) { return 1.0; });
  EXPECT_TRUE(std::isnan(score.psnr));
  EXPECT_TRUE(std::isnan(score.perceptual));
  EXPECT_EQ(score.overlap, 0);
}

TEST(Consistency, of_a_view_with_itself_is_infinite) {
  const View view = linear_view(intrinsics_from_fov(20, 10, 60), Pose::Identity());
  EXPECT_EQ(consistency(view, view).psnr, std::numeric_limits<double>::infinity());
  EXPECT_EQ(consistency(view, view).overlap, 1);
}

TEST(Consistency, does_not_depend_on_threads) {
  const TurnedRoom room(5, 0.3, 0.1, 64);
  set_threads(1);
  const ConsistencyScore one = consistency(room.first, room.second);
  set_threads(3);
  const ConsistencyScore three = consistency(room.first, room.second);
  set_threads(0);
  EXPECT_EQ(one.psnr, three.psnr);
}

TEST(Consistency, refuses_views_from_two_places_and_unsound_ones) {
  const Intrinsics k = intrinsics_from_fov(20, 10, 60);
  const View view = linear_view(k, Pose::Identity());
  View moved = view;
  moved.world_from_cam.translation().x() = 0.01;
  EXPECT_THROW(consistency(view, moved), Error);
  View cut = view;
  cut.color = cut.color.colRange(0, 19);
  EXPECT_THROW(consistency(view, cut), Error);
  EXPECT_THROW(consistency(cut, view), Error);
  View mirrored = view;
  mirrored.world_from_cam.linear()(0, 0) = -1;
  EXPECT_THROW(consistency(view, mirrored), Error);
  EXPECT_THROW(consistency(View(), View()), Error);
}

}  // namespace
}  // namespace ps
