// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/outpainter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "tests/io/support.h"
#include "tests/support/random_weights.h"

namespace ps::outpaint {
namespace {

constexpr int kHeight = 128, kWidth = 192;

/// Narrow networks by chance, and a view whose right side is missing.
class OutpainterOfRandomWeights : public testing::Test {
 protected:
  OutpainterOfRandomWeights() : projection_({1, kHeight, kWidth, 3}) {
    background_(cv::Rect(151, 0, kWidth - 151, 64)) = 1;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        for (int c = 0; c < 3; ++c) {
          projection_.view().pixel(0, y, x)[c] =
              background_(y, x)
                  ? 0
                  : std::sin(0.1f * static_cast<float>(x + 7 * c) + 0.05f * static_cast<float>(y));
        }
      }
    }
  }

  Outpainter outpainter(std::vector<Scorer> scorers) const {
    return Outpainter({&autoencoder_, &pixel_cnn_, &refiner_, std::move(scorers)});
  }
  /// Remembers every picture it is shown; scores them in turn.
  Scorer recorder(std::vector<double> scores = {}) {
    return {"recorder", true, [this, scores](const nn::TensorView& image, nn::Workspace&) {
              nn::Tensor copy(image.shape);
              std::copy_n(image.data, image.shape.pixels() * 3, copy.data());
              seen_.push_back(std::move(copy));
              return scores.empty() ? 0 : scores[(seen_.size() - 1) % scores.size()];
            }};
  }

  /// The whole view, network after network.
  nn::Tensor refined_whole(const std::vector<std::int32_t>& codes, const OutpaintOptions& options) {
    nn::Tensor decoded({1, kHeight, kWidth, 3}), input({1, kHeight, kWidth, 4}),
        out(decoded.shape());
    autoencoder_.decode(codes.data(), decoded, workspace_);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const nn::TensorView& from = background_(y, x) ? decoded.view() : projection_.view();
        std::copy_n(from.pixel(0, y, x), 3, input.view().pixel(0, y, x));
        input.view().pixel(0, y, x)[3] = background_(y, x) ? 0 : 1;
      }
    }
    std::vector<float> noise;
    for (std::uint32_t i = 0; noise.size() < refiner_.noise_count(); ++i) {
      for (const double n : random_normal(options.seed, {options.view, 0, i, 1})) {
        noise.push_back(static_cast<float>(n));
      }
    }
    refiner_.forward(input, noise.data(), out, workspace_);
    return out;
  }

  models::Autoencoder autoencoder_{models::random_autoencoder(16, 8, 8, 24)};
  models::PixelCnn pixel_cnn_{models::random_pixel_cnn(11, 24)};
  models::Refiner refiner_{models::random_refiner(8)};
  models::Discriminator discriminator_{models::random_discriminator(8)};
  models::Classifier classifier_{models::random_classifier(8, 10)};
  nn::Tensor projection_;
  cv::Mat1b background_ = cv::Mat1b::zeros(kHeight, kWidth);
  std::vector<nn::Tensor> seen_;
  nn::Workspace workspace_;
};

double worst_difference(const nn::Tensor& a, const nn::Tensor& b) {
  EXPECT_EQ(a.shape(), b.shape());
  double worst = 0;
  for (std::size_t i = 0; i < a.shape().pixels() * 3; ++i) {
    const double difference = std::abs(a.data()[i] - b.data()[i]);
    if (!(difference <= worst)) worst = difference;  // also when it is NaN
  }
  return worst;
}

TEST_F(OutpainterOfRandomWeights, a_part_of_the_view_gives_what_the_whole_view_gives) {
  OutpaintOptions options;
  options.samples = 4;
  options.seed = 5;
  std::vector<std::int32_t> codes(kHeight / 8 * kWidth / 8);
  autoencoder_.encode(projection_, codes.data(), workspace_);
  const auto completions = Sampler(pixel_cnn_, order_of(background_), codes)
                               .sample(0, 4, {0.7, 5, 0, nullptr, nullptr, nullptr});
  const Outpainted result =
      outpainter({recorder({1, 0, 3, 2})}).run(projection_, background_, options);
  ASSERT_EQ(seen_.size(), 4u);
  EXPECT_LT(result.report.changed.area(), kHeight * kWidth * 3 / 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const nn::Tensor whole = refined_whole(completions[i].codes, options);
    EXPECT_LE(worst_difference(seen_[i], whole), 1e-4) << i;
  }
  EXPECT_GT(worst_difference(seen_[0], seen_[1]), 1e-2);  // completions do differ
  EXPECT_EQ(result.best, 2);
  EXPECT_EQ(result.codes, completions[2].codes);
  EXPECT_LE(worst_difference(result.image, refined_whole(result.codes, options)), 1e-6);
  EXPECT_EQ(result.report.drawn, 4);
  EXPECT_EQ(result.report.refined, 4);
}

TEST_F(OutpainterOfRandomWeights, nothing_missing_costs_nothing) {
  background_ = 0;
  const Outpainted result = outpainter({recorder()}).run(projection_, background_, {});
  EXPECT_EQ(worst_difference(result.image, projection_), 0);
  EXPECT_EQ(result.report.drawn, 0);
  EXPECT_TRUE(seen_.empty());
}

TEST_F(OutpainterOfRandomWeights, a_missing_rim_without_a_whole_cell_takes_one_completion) {
  background_ = 0;
  background_(cv::Rect(0, 0, 5, kHeight)) = 1;
  const Outpainted result = outpainter({recorder()}).run(projection_, background_, {});
  EXPECT_EQ(result.report.missing_cells, 0u);
  EXPECT_EQ(result.report.drawn, 1);
  EXPECT_GT(worst_difference(result.image, projection_), 0);
}

TEST_F(OutpainterOfRandomWeights, the_best_is_that_of_the_signals_totals) {
  OutpaintOptions options;
  options.samples = 6;
  options.likelihood = true;
  const Outpainted result =
      outpainter({discriminator_scorer(discriminator_), entropy_scorer(classifier_)})
          .run(projection_, background_, options);
  ASSERT_EQ(result.scores.size(), 3u);
  const std::vector<double> expected =
      totals({{result.scores[0], true}, {result.scores[1], false}, {result.scores[2], true}});
  EXPECT_EQ(result.totals, expected);
  EXPECT_EQ(result.best, static_cast<int>(best_of(expected)));
}

TEST_F(OutpainterOfRandomWeights, draws_in_rounds_until_the_best_has_settled) {
  OutpaintOptions options;
  options.until_settled = true;
  options.samples = 100;
  std::vector<double> early(100, 0), late(100, 0);
  early[3] = 1;  // leads from the first round on
  late[20] = 1;  // takes the lead in the third
  const Outpainted first = outpainter({recorder(early)}).run(projection_, background_, options);
  EXPECT_EQ(first.best, 3);
  EXPECT_EQ(first.report.drawn, 16);
  seen_.clear();
  late[2] = 0.5;
  late[9] = 0.6;  // changes the lead in the second round, so it is not settled then
  const Outpainted second = outpainter({recorder(late)}).run(projection_, background_, options);
  EXPECT_EQ(second.best, 20);
  EXPECT_EQ(second.report.drawn, 48);
}

TEST_F(OutpainterOfRandomWeights, only_the_likeliest_few_are_refined_when_asked) {
  OutpaintOptions options;
  options.samples = 10;
  options.refine_best = 3;
  options.screen = OutpaintOptions::Screen::likelihood;
  const Outpainted result = outpainter({recorder()}).run(projection_, background_, options);
  EXPECT_EQ(seen_.size(), 3u);
  EXPECT_EQ(result.report.drawn, 10);
  EXPECT_EQ(result.report.refined, 3);
  std::vector<std::int32_t> codes(kHeight / 8 * kWidth / 8);
  autoencoder_.encode(projection_, codes.data(), workspace_);
  const auto completions = Sampler(pixel_cnn_, order_of(background_), codes).sample(0, 10);
  double least = 0;
  for (const int i : result.refined) {
    least = std::min(least, completions[static_cast<std::size_t>(i)].log_likelihood);
  }
  for (int i = 0; i < 10; ++i) {
    const bool refined = std::count(result.refined.begin(), result.refined.end(), i) > 0;
    if (!refined) {
      EXPECT_LE(completions[static_cast<std::size_t>(i)].log_likelihood, least);
    }
  }
}

TEST_F(OutpainterOfRandomWeights, only_the_best_few_before_refinement_are_refined_when_asked) {
  OutpaintOptions options;
  options.samples = 5;
  options.refine_best = 2;
  // What the scorer says of the five unrefined pictures, then of the two that it chose: 1 and 4.
  const Outpainted result =
      outpainter({recorder({0, 4, 1, 2, 3, 8, 9})}).run(projection_, background_, options);
  EXPECT_EQ(seen_.size(), 7u);
  EXPECT_EQ(result.refined, (std::vector<int>{1, 4}));
  EXPECT_EQ(result.best, 4);
}

TEST_F(OutpainterOfRandomWeights, the_same_bytes_for_any_number_of_threads) {
  OutpaintOptions options;
  options.samples = 3;
  std::vector<nn::Tensor> images;
  for (const int threads : {1, 2, 3}) {
    set_threads(threads);
    images.push_back(outpainter({discriminator_scorer(discriminator_)})
                         .run(projection_, background_, options)
                         .image);
    EXPECT_EQ(worst_difference(images.front(), images.back()), 0) << threads;
  }
  set_threads(0);
}

TEST_F(OutpainterOfRandomWeights, stops_when_it_is_told_to) {
  OutpaintOptions options;
  options.progress = [](double) { return false; };
  const Outpainted result = outpainter({}).run(projection_, background_, options);
  EXPECT_EQ(result.best, -1);
  EXPECT_EQ(result.image.shape().pixels(), 0u);
}

TEST_F(OutpainterOfRandomWeights, errors_say_what_is_wrong) {
  Outpainter painter = outpainter({});
  OutpaintOptions options;
  options.samples = 0;
  EXPECT_TRUE(has(error_of([&] { painter.run(projection_, background_, options); }), "samples"));
  options = {};
  options.refine_best = 2;
  options.until_settled = true;
  EXPECT_TRUE(
      has(error_of([&] { painter.run(projection_, background_, options); }), "one or the other"));
  const cv::Mat1b other(kHeight, kWidth - 8, std::uint8_t{0});
  EXPECT_TRUE(has(error_of([&] { painter.run(projection_, other, {}); }), "do not fit"));
  EXPECT_TRUE(has(error_of([] { Outpainter({}); }), "a network is missing"));
}

}  // namespace
}  // namespace ps::outpaint
