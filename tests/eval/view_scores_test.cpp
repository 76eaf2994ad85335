// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/view_scores.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libps/core/error.h"
#include "libps/eval/frechet.h"
#include "libps/eval/image_metrics.h"

namespace ps {
namespace {

Image noise(int seed) {
  Image image(32, 40);
  cv::RNG rng(static_cast<std::uint64_t>(seed));
  rng.fill(image, cv::RNG::UNIFORM, 0.2, 0.8);
  return image;
}

/// The left half is visible, of the right all but the last columns invisible.
Visibility halves() {
  Visibility v = {Mask::zeros(32, 40), Mask::zeros(32, 40)};
  v.visible(cv::Rect(0, 0, 20, 32)).setTo(1);
  v.invisible(cv::Rect(20, 0, 16, 32)).setTo(1);
  return v;
}

TEST(ViewScores, each_mask_is_scored_by_itself) {
  const Image truth = noise(1);
  Image shown = truth + cv::Scalar::all(0.1);
  shown(cv::Rect(20, 0, 16, 32)) -= cv::Scalar::all(0.11);
  const ViewScores scores = view_scores(shown, truth, halves());
  EXPECT_NEAR(scores.psnr_visible, 20, 1e-4);
  EXPECT_NEAR(scores.psnr_invisible, 40, 1e-3);
  // By hand: 24 of 40 columns are off by 0.1, 16 by 0.01.
  EXPECT_NEAR(scores.psnr, -10 * std::log10((24 * 0.01 + 16 * 0.0001) / 40), 1e-4);
  EXPECT_EQ(scores.ssim, ssim(shown, truth));
  EXPECT_TRUE(std::isnan(scores.perceptual));
}

TEST(ViewScores, an_empty_mask_has_no_score) {
  const Image truth = noise(1);
  Visibility all = halves();
  all.invisible.setTo(0);
  const auto constant = [](const Image&, const Image&) { return 0.25; };
  const ViewScores scores = view_scores(noise(2), truth, all, constant);
  EXPECT_TRUE(std::isnan(scores.psnr_invisible));
  EXPECT_TRUE(std::isfinite(scores.psnr_visible));
  EXPECT_EQ(scores.perceptual, 0.25);
  all.visible.setTo(0);
  EXPECT_TRUE(std::isnan(view_scores(noise(2), truth, all).psnr_visible));
}

TEST(ViewScores, without_masks_neither_part_has_a_score) {
  const ViewScores scores = view_scores(noise(2), noise(1), {});
  EXPECT_TRUE(std::isnan(scores.psnr_visible));
  EXPECT_TRUE(std::isnan(scores.psnr_invisible));
  EXPECT_EQ(scores.psnr, psnr(noise(2), noise(1)));
}

TEST(ViewScores, refuse_pictures_of_other_sizes) {
  EXPECT_THROW(view_scores(Image(32, 41), noise(1), halves()), Error);
  EXPECT_THROW(view_scores(Image(16, 20), Image(16, 20), halves()), Error);
}

FeatureNetwork means() {
  return {"mean colour", [](const Image& image) {
            const cv::Scalar mean = cv::mean(image);
            return std::vector<float>{static_cast<float>(mean[0]), static_cast<float>(mean[1])};
          }};
}

TEST(FrechetScores, are_the_distance_between_each_method_and_the_truth) {
  FrechetScores scores(means());
  for (int i = 0; i < 6; ++i) {
    scores.add_truth(noise(i));
    scores.add("same", noise(i));
    scores.add("brighter", noise(i) + cv::Scalar::all(0.1));
  }
  EXPECT_EQ(scores.count("same"), 6u);
  EXPECT_NEAR(scores.distance("same"), 0, 1e-9);
  // The spread is the same, so the distance is that of the means: two features, 0.1 apart.
  EXPECT_NEAR(scores.distance("brighter"), 2 * 0.1 * 0.1, 1e-5);
}

TEST(FrechetScores, are_none_of_fewer_than_two_pictures) {
  FrechetScores scores(means());
  scores.add_truth(noise(1));
  scores.add("a", noise(1));
  EXPECT_TRUE(std::isnan(scores.distance("a")));
  scores.add("a", noise(2));
  EXPECT_TRUE(std::isnan(scores.distance("a")));
  scores.add_truth(noise(3));
  EXPECT_TRUE(std::isfinite(scores.distance("a")));
  EXPECT_TRUE(std::isnan(scores.distance("b")));
}

TEST(FrechetScores, refuse_features_of_another_number) {
  FrechetScores scores({"rows", [](const Image& image) {
                          return std::vector<float>(static_cast<std::size_t>(image.rows));
                        }});
  scores.add_truth(Image(3, 4));
  EXPECT_THROW(scores.add("a", Image(4, 4)), Error);
  EXPECT_EQ(scores.count("a"), 0u);
}

}  // namespace
}  // namespace ps
