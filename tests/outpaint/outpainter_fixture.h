// SPDX-License-Identifier: BSD-3-Clause
// Narrow networks by chance and a view, for the tests of the outpainter.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "libps/core/random.h"
#include "libps/outpaint/nearest_seen.h"
#include "libps/outpaint/outpainter.h"
#include "tests/support/random_weights.h"

namespace ps::outpaint {

inline constexpr int kHeight = 128, kWidth = 192;

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

  /// What the sampler is given: codes of the projection with the nearest colours where it is
  /// missing.
  std::vector<std::int32_t> known_codes() {
    return codes_of(with_nearest_colors(projection_.view(), background_));
  }
  std::vector<std::int32_t> codes_of(const nn::Tensor& image) {
    std::vector<std::int32_t> codes(kHeight / 8 * kWidth / 8);
    autoencoder_.encode(image, codes.data(), workspace_);
    return codes;
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

inline double worst_difference(const nn::Tensor& a, const nn::Tensor& b) {
  EXPECT_EQ(a.shape(), b.shape());
  double worst = 0;
  for (std::size_t i = 0; i < a.shape().pixels() * 3; ++i) {
    const double difference = std::abs(a.data()[i] - b.data()[i]);
    if (!(difference <= worst)) worst = difference;  // also when it is NaN
  }
  return worst;
}

}  // namespace ps::outpaint
