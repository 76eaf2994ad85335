// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/image_metrics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "libps/core/error.h"

namespace ps {
namespace {

Image random_image(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  Image image(height, width);
  for (cv::Vec3f& rgb : image) rgb = {uniform(random), uniform(random), uniform(random)};
  return image;
}

Mask random_mask(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Mask mask(height, width);
  for (std::uint8_t& chosen : mask) chosen = random() % 3 == 0;
  return mask;
}

/// The formula, pixel by pixel.
double psnr_reference(const Image& a, const Image& b, const Mask& where) {
  double sum = 0;
  int chosen = 0;
  for (int i = 0; i < a.rows * a.cols; ++i) {
    if (!where(i / a.cols, i % a.cols)) continue;
    const cv::Vec3d d = cv::Vec3d(a(i / a.cols, i % a.cols)) - cv::Vec3d(b(i / a.cols, i % a.cols));
    sum += d.dot(d) / 3;
    ++chosen;
  }
  return 10 * std::log10(1 / (sum / chosen));
}

double grey(const Image& image, int x, int y) {
  return 0.299 * image(y, x)[0] + 0.587 * image(y, x)[1] + 0.114 * image(y, x)[2];
}

/// Wang et al. (2004), equations 13 to 16, one window at (u, v).
double ssim_window(const Image& a, const Image& b, int u, int v) {
  double weights = 0, mean_a = 0, mean_b = 0, var_a = 0, var_b = 0, cov = 0;
  const auto each = [&](auto&& body) {
    for (int dy = -5; dy <= 5; ++dy) {
      for (int dx = -5; dx <= 5; ++dx) {
        body(std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5)), grey(a, u + dx, v + dy),
             grey(b, u + dx, v + dy));
      }
    }
  };
  each([&](double w, double, double) { weights += w; });
  each([&](double w, double p, double q) {
    mean_a += w / weights * p;
    mean_b += w / weights * q;
  });
  each([&](double w, double p, double q) {
    var_a += w / weights * (p - mean_a) * (p - mean_a);
    var_b += w / weights * (q - mean_b) * (q - mean_b);
    cov += w / weights * (p - mean_a) * (q - mean_b);
  });
  const double c1 = 1e-4, c2 = 9e-4;
  return (2 * mean_a * mean_b + c1) * (2 * cov + c2) /
         ((mean_a * mean_a + mean_b * mean_b + c1) * (var_a + var_b + c2));
}

double ssim_reference(const Image& a, const Image& b, const Mask& where) {
  double sum = 0;
  int chosen = 0;
  for (int v = 5; v < a.rows - 5; ++v) {
    for (int u = 5; u < a.cols - 5; ++u) {
      if (!where(v, u)) continue;
      sum += ssim_window(a, b, u, v);
      ++chosen;
    }
  }
  return sum / chosen;
}

constexpr std::array<std::array<int, 2>, 5> kSizes = {
    {{11, 11}, {12, 17}, {40, 13}, {31, 32}, {20, 50}}};

TEST(Psnr, is_what_the_formula_gives) {
  for (const auto& [width, height] : kSizes) {
    const Image a = random_image(width, height, 1), b = random_image(width, height, 2);
    const Mask where = random_mask(width, height, 3);
    EXPECT_NEAR(psnr(a, b, where), psnr_reference(a, b, where), 1e-9);
    EXPECT_NEAR(psnr(a, b), psnr_reference(a, b, Mask::ones(a.size())), 1e-9);
  }
}

TEST(Psnr, of_a_difference_of_a_tenth_is_20_dB) {
  const Image a(4, 5, cv::Vec3f(0.25f, 0.5f, 0.75f));
  EXPECT_NEAR(psnr(a, a + cv::Scalar(0.1, 0.1, 0.1)), 20, 1e-5);
}

TEST(Psnr, of_equal_images_is_infinite) {
  const Image a = random_image(7, 5, 1);
  EXPECT_EQ(psnr(a, a.clone()), std::numeric_limits<double>::infinity());
}

TEST(Psnr, sees_only_chosen_pixels) {
  const Image a = random_image(7, 5, 1);
  Image b = a.clone();
  b(2, 3)[1] += 0.5f;
  Mask where = Mask::ones(a.size());
  where(2, 3) = 0;
  EXPECT_EQ(psnr(a, b, where), std::numeric_limits<double>::infinity());
  EXPECT_LT(psnr(a, b, 1 - where), psnr(a, b));
}

TEST(Psnr, of_no_pixel_is_nan) {
  const Image a = random_image(7, 5, 1);
  EXPECT_TRUE(std::isnan(psnr(a, a, Mask::zeros(a.size()))));
  EXPECT_TRUE(std::isnan(psnr(Image(), Image())));
}

TEST(Psnr, differing_sizes_throw) {
  const Image a = random_image(7, 5, 1);
  EXPECT_THROW(psnr(a, random_image(5, 7, 1)), Error);
  EXPECT_THROW(psnr(a, a, Mask::ones(7, 5)), Error);
}

TEST(Ssim, is_what_the_paper_defines) {
  for (const auto& [width, height] : kSizes) {
    const Image a = random_image(width, height, 1);
    const Image b = 0.7 * a + 0.3 * random_image(width, height, 2);
    Mask where = random_mask(width, height, 3);
    where(5, 5) = 1;
    EXPECT_NEAR(ssim(a, b, where), ssim_reference(a, b, where), 1e-9);
    EXPECT_NEAR(ssim(a, b), ssim_reference(a, b, Mask::ones(a.size())), 1e-9);
  }
}

TEST(Ssim, of_equal_images_is_one_and_of_opposite_ones_below_zero) {
  const Image a = random_image(30, 20, 1);
  EXPECT_NEAR(ssim(a, a.clone()), 1, 1e-12);
  EXPECT_LT(ssim(a, cv::Scalar(1, 1, 1) - a), 0);
}

TEST(Ssim, is_symmetric) {
  const Image a = random_image(30, 20, 1), b = random_image(30, 20, 2);
  EXPECT_NEAR(ssim(a, b), ssim(b, a), 1e-12);
}

TEST(Ssim, of_no_whole_window_is_nan) {
  const Image narrow = random_image(10, 40, 1);
  EXPECT_TRUE(std::isnan(ssim(narrow, narrow)));
  EXPECT_TRUE(std::isnan(ssim(Image(), Image())));
  const Image a = random_image(20, 20, 1);
  Mask corner = Mask::zeros(a.size());
  corner(4, 4) = 1;
  EXPECT_TRUE(std::isnan(ssim(a, a, corner)));
}

TEST(Ssim, differing_sizes_throw) {
  const Image a = random_image(20, 15, 1);
  EXPECT_THROW(ssim(a, random_image(15, 20, 1)), Error);
  EXPECT_THROW(ssim(a, a, Mask::ones(20, 15)), Error);
}

}  // namespace
}  // namespace ps
