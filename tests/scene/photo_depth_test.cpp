// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/photo_depth.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "tests/support/random_weights.h"

namespace ps {
namespace {

const models::DepthNet& net() {
  static const models::DepthNet kNet(models::random_depth_net(4));
  return kNet;
}

/// Smooth, with a coarse chequer that is not the same anywhere.
Image picture(int width, int height) {
  Image image(height, width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(height);
      const float v = static_cast<float>(y) / static_cast<float>(height);
      image(y, x) = {0.5f + 0.5f * std::sin(7 * u + v), 0.5f + 0.5f * std::sin(3 * u - 5 * v * u),
                     std::fmod(std::floor(5 * u) * 0.37f + std::floor(4 * v) * 0.21f, 1.f)};
    }
  }
  return image;
}

/// Depth as the canonical camera would see it.
Depth depth_of(const Image& photo, const DepthScale& scale = {}) {
  Intrinsics lens = intrinsics_from_fov(photo.cols, photo.rows, 60);
  lens.fx = lens.fy = scale.canonical_focal * std::min(photo.cols, photo.rows);
  return photo_depth(net(), photo, lens, scale);
}

/// The greatest step of the logarithm between columns x - 1 and x.
double step_at(const Depth& depth, int x) {
  cv::Mat1f logarithm;
  cv::log(depth.colRange(x - 1, x + 1), logarithm);
  return cv::norm(logarithm.col(0), logarithm.col(1), cv::NORM_INF);
}

double greatest_ratio(const Depth& a, const Depth& b) {
  cv::Mat1f ratio;
  cv::log(a / b, ratio);
  return cv::norm(ratio, cv::NORM_INF);
}

Image mirrored(const Image& image) {
  Image out;
  cv::flip(image, out, 1);
  return out;
}

/// The bare network's logarithm of depth.
cv::Mat1f said_of(const Image& photo, const DepthScale& scale) {
  nn::Tensor image({1, 256, 256, 3}), raw({1, 256, 256, 1});
  for (std::size_t i = 0; i < photo.total() * 3; ++i) {
    image.data()[i] = photo.ptr<float>()[i] * 2 - 1;
  }
  nn::Workspace workspace;
  net().forward(image, raw, workspace);
  nn::Tensor depth(raw.shape());
  models::depth_of_raw(raw, scale.min_z, scale.max_z, depth);
  cv::Mat1f logarithm;
  cv::log(cv::Mat1f(256, 256, depth.data()), logarithm);
  return logarithm;
}

TEST(PhotoDepth, a_square_photo_gets_what_the_bare_network_says_of_it_and_its_mirror_image) {
  const Image photo = picture(256, 256);
  for (const DepthScale& scale : {DepthScale{1, 100, 1}, DepthScale{0.25f, 8, 0.5}}) {
    cv::Mat1f other, expected;
    cv::flip(said_of(mirrored(photo), scale), other, 1);
    cv::exp((said_of(photo, scale) + other) / 2, expected);
    const Depth depth = depth_of(photo, scale);
    EXPECT_LT(greatest_ratio(depth, expected), 1e-5);
    double least = 0, greatest = 0;
    cv::minMaxLoc(depth, &least, &greatest);
    EXPECT_GT(greatest, 1.05 * least) << "a network that says nothing proves nothing";
  }
}

TEST(PhotoDepth, of_a_mirror_image_is_mirrored) {
  const Image photo = picture(400, 256);
  Depth other;
  cv::flip(depth_of(mirrored(photo)), other, 1);
  EXPECT_LT(greatest_ratio(depth_of(photo), other), 1e-4);
}

TEST(PhotoDepth, a_wide_photo_has_no_step_where_squares_begin_and_end) {
  const Image photo = picture(1000, 256);  // squares begin at 0, 148, 297, ... and end 256 later
  const Depth depth = depth_of(photo);
  std::vector<double> seams, inside;
  for (int x = 1; x < photo.cols; ++x) {
    bool seam = false;
    for (int i = 1; i < 5; ++i) {
      const int start = 744 * i / 5;
      seam = seam || std::abs(x - start) < 2 || std::abs(photo.cols - x - start) < 2;
    }
    (seam ? seams : inside).push_back(step_at(depth, x));
  }
  std::sort(inside.begin(), inside.end());
  EXPECT_LE(*std::max_element(seams.begin(), seams.end()), inside.back());
  std::sort(seams.begin(), seams.end());
  EXPECT_LE(seams[seams.size() / 2], 1.5 * inside[inside.size() / 2]);
}

TEST(PhotoDepth, squares_that_disagree_by_a_factor_meet_in_the_middle) {
  // One half is darker: the network says other depths of it.
  Image photo = picture(416, 256);
  photo.colRange(208, 416) *= 0.2;
  const Depth wide = depth_of(photo);
  const Depth left = depth_of(photo.colRange(0, 256)), right = depth_of(photo.colRange(160, 416));
  const auto logarithms = [](const Depth& a, const Depth& b) {
    cv::Mat1f ratio;
    cv::log(a / b, ratio);
    std::vector<float> values(ratio.begin(), ratio.end());
    std::sort(values.begin(), values.end());
    return values;
  };
  const std::vector<float> apart = logarithms(right.colRange(0, 96), left.colRange(160, 256));
  const float half = apart[apart.size() / 2] / 2;
  EXPECT_GT(std::abs(half), 1e-4) << "squares that agree prove nothing";
  for (const float value : logarithms(wide.colRange(0, 160), left.colRange(0, 160))) {
    ASSERT_NEAR(value, half, 1e-5);
  }
  for (const float value : logarithms(wide.colRange(256, 416), right.colRange(96, 256))) {
    ASSERT_NEAR(value, -half, 1e-5);
  }
}

TEST(PhotoDepth, an_upright_photo_is_covered_from_top_to_bottom) {
  const Image photo = picture(256, 620);
  const Depth depth = depth_of(photo);
  const Depth top = depth_of(photo.rowRange(0, 256));
  EXPECT_EQ(depth.size(), photo.size());
  const Depth ratio = depth.rowRange(0, 60) / top.rowRange(0, 60);
  double least = 0, greatest = 0;
  cv::minMaxLoc(ratio, &least, &greatest);
  EXPECT_NEAR(greatest / least, 1, 1e-4);
}

TEST(PhotoDepth, depth_is_proportional_to_the_focal_length) {
  const Image photo = picture(300, 200);
  Intrinsics lens = intrinsics_from_fov(300, 200, 60);
  const Depth once = photo_depth(net(), photo, lens);
  lens.fx *= 8;
  lens.fy *= 2;  // the geometric mean counts
  EXPECT_LT(greatest_ratio(photo_depth(net(), photo, lens), once * 4), 1e-5);
  const Depth canonical = photo_depth(net(), photo, lens, {1, 100, 2});
  EXPECT_LT(greatest_ratio(canonical, once * 2), 1e-5);
}

TEST(PhotoDepth, the_same_view_in_more_pixels_has_the_same_depth) {
  const Image photo = picture(384, 256);
  Image large;
  cv::resize(photo, large, {}, 3, 3, cv::INTER_CUBIC);
  const Depth small_depth = photo_depth(net(), photo, intrinsics_from_fov(384, 256, 60));
  Depth large_depth = photo_depth(net(), large, intrinsics_from_fov(1152, 768, 60));
  ASSERT_EQ(large_depth.size(), large.size());
  cv::resize(large_depth, large_depth, photo.size(), 0, 0, cv::INTER_AREA);
  cv::Mat1f ratio;
  cv::log(large_depth / small_depth, ratio);
  EXPECT_LT(cv::norm(ratio, cv::NORM_L1) / static_cast<double>(ratio.total()), 0.02);
}

TEST(PhotoDepth, every_size_gets_a_depth_at_every_pixel) {
  for (const cv::Size size : {cv::Size(1, 1),
                              {16, 16},
                              {100, 1},
                              {1, 100},
                              {257, 256},
                              {255, 256},
                              {3000, 500},
                              {31, 900}}) {
    const Depth depth = depth_of(picture(size.width, size.height));
    ASSERT_EQ(depth.size(), size);
    EXPECT_TRUE(cv::checkRange(depth, true, nullptr, 1e-3, 1e4)) << size;
  }
}

TEST(PhotoDepth, refuses_what_is_unsound) {
  const Intrinsics lens = intrinsics_from_fov(16, 16, 60);
  const Image photo = picture(16, 16);
  EXPECT_THROW(photo_depth(net(), Image(), lens), Error);
  EXPECT_THROW(photo_depth(net(), picture(202, 2), lens), Error);
  EXPECT_THROW(photo_depth(net(), photo, Intrinsics()), Error);
  const float nan = std::nanf("");
  for (const DepthScale& scale : {DepthScale{0, 1, 1},
                                  {2, 1, 1},
                                  {1, 2, 0},
                                  {nan, 2, 1},
                                  {1, nan, 1},
                                  {1, 2, std::nan("")},
                                  {1, INFINITY, 1}}) {
    EXPECT_THROW(photo_depth(net(), photo, lens, scale), Error);
  }
}

TEST(PhotoDepth, a_network_that_gives_no_number_is_an_error) {
  auto tensors = models::random_depth_net(2).tensors();
  for (float& value : tensors.at("pts_regressor.dconv8.weight").values) value *= 3e38f;
  const models::DepthNet wild(nn::Weights("wild", std::move(tensors)));
  EXPECT_THROW(photo_depth(wild, picture(400, 256), intrinsics_from_fov(400, 256, 60)), Error);
}

TEST(FillHoles, leaves_what_is_known_and_goes_on_from_it) {
  View view;
  view.color = picture(256, 256);
  view.intrinsics = intrinsics_from_fov(256, 256, 60);
  view.depth = photo_depth(net(), view.color, view.intrinsics) * 3;  // in another unit
  const Depth truth = view.depth.clone();
  EXPECT_EQ(fill_holes(view, net(), {}).pixels, 0);
  view.depth(cv::Rect(100, 80, 40, 60)) = 0;
  const FilledHoles filled = fill_holes(view, net(), {});
  EXPECT_EQ(filled.pixels, 40 * 60);
  EXPECT_TRUE(filled.agreed) << filled.why;
  EXPECT_LT(greatest_ratio(view.depth, truth), 0.02);
  Mask known(256, 256, 1);
  known(cv::Rect(100, 80, 40, 60)) = 0;
  EXPECT_EQ(cv::norm(view.depth, truth, cv::NORM_INF, known), 0);
}

}  // namespace
}  // namespace ps
