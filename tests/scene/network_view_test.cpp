// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/network_view.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"

namespace ps {
namespace {

Intrinsics lens_of(int width, int height) {
  Intrinsics lens = intrinsics_from_fov(width, height, 70);
  lens.cx += 0.03 * width;
  lens.fy *= 1.01;
  return lens;
}

TEST(NetworkView, keeps_every_direction_and_cuts_nothing_off) {
  for (const cv::Size size : {cv::Size(540, 360), cv::Size(16, 16), cv::Size(4001, 2999),
                              cv::Size(97, 1000), cv::Size(256, 256), cv::Size(1, 3)}) {
    const Intrinsics lens = lens_of(size.width, size.height), seen = network_lens(lens);
    EXPECT_EQ(seen.width % 8, 0) << size;
    EXPECT_EQ(seen.height % 8, 0) << size;
    EXPECT_EQ(std::min(seen.width, seen.height), 256) << size;
    EXPECT_NEAR(seen.fx / seen.fy, lens.fx / lens.fy, 1e-12) << "squashed";
    // The photo's corners (half a pixel beyond the outermost centres) fall inside the picture.
    for (const double x : {-0.5, lens.width - 0.5}) {
      for (const double y : {-0.5, lens.height - 0.5}) {
        const Eigen::Vector2d corner = seen.project(lens.lift(x, y, 1));
        EXPECT_GE(corner.x(), -0.51) << size;
        EXPECT_GE(corner.y(), -0.51) << size;
        EXPECT_LE(corner.x(), seen.width - 0.49) << size;
        EXPECT_LE(corner.y(), seen.height - 0.49) << size;
      }
    }
  }
  EXPECT_EQ(network_lens(lens_of(256, 256)).cx, lens_of(256, 256).cx);
}

TEST(NetworkView, resampling_puts_every_direction_where_the_lens_sees_it) {
  const Intrinsics lens = lens_of(530, 371), seen = network_lens(lens);
  // A picture that is linear in the direction, which bicubic interpolation keeps.
  const auto paint = [](const Intrinsics& k) {
    Image image(k.height, k.width);
    for (int y = 0; y < k.height; ++y) {
      for (int x = 0; x < k.width; ++x) {
        const Eigen::Vector3d ray = k.lift(x, y, 1);
        image(y, x) = {static_cast<float>(0.5 + 0.3 * ray.x()),
                       static_cast<float>(0.5 + 0.3 * ray.y()), 0.25f};
      }
    }
    return image;
  };
  const cv::Rect inside(4, 4, lens.width - 8, lens.height - 8);
  const Image back = resampled(paint(seen), seen, lens);
  EXPECT_LT(cv::norm(back(inside), paint(lens)(inside), cv::NORM_INF), 1e-3);
}

TEST(NetworkView, there_and_back_is_the_same_picture_clamped) {
  Image image(2, 3, cv::Vec3f(0.25f, 0.5f, 1.f));
  image(1, 2) = {0, 1, 0.125f};
  EXPECT_LT(cv::norm(from_network(to_network(image)), image, cv::NORM_INF), 1e-6);
  nn::Tensor wild({1, 1, 1, 3});
  wild.data()[0] = -3;
  wild.data()[1] = 3;
  EXPECT_EQ(from_network(wild)(0, 0), cv::Vec3f(0, 1, 0.5f));
}

TEST(NetworkView, an_unsound_lens_is_refused) { EXPECT_THROW(network_lens({}), Error); }

}  // namespace
}  // namespace ps
