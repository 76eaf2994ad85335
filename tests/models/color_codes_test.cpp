// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/color_codes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "libps/models/autoencoder.h"

namespace ps::models {
namespace {

TEST(ColorCodes, are_the_mean_colours_of_cells_to_half_a_level_and_decode_to_squares) {
  const Autoencoder net(color_codes());
  ASSERT_EQ(net.codes(), 512);
  constexpr int kHeight = 16, kWidth = 24, kCell = Autoencoder::kCell;
  nn::Tensor image({1, kHeight, kWidth, 3}), made({1, kHeight, kWidth, 3});
  float* const value = image.data();
  for (int i = 0; i < kHeight * kWidth * 3; ++i) value[i] = std::sin(.37f * static_cast<float>(i));
  for (int i = 0; i < kCell; ++i) value[i * kWidth * 3] = 1;  // the mean of a cell at a corner
  nn::Workspace workspace;
  std::vector<std::int32_t> codes(6);
  net.encode(image.view(), codes.data(), workspace);
  net.decode(codes.data(), made.view(), workspace);
  const auto at = [&](const float* from, int y, int x, int c) {
    return from[(y * kWidth + x) * 3 + c];
  };
  for (int cell = 0; cell < 6; ++cell) {
    const int top = cell / 3 * kCell, left = cell % 3 * kCell;
    for (int c = 0; c < 3; ++c) {
      double mean = 0;
      for (int i = 0; i < 64; ++i) mean += at(image.data(), top + i / 8, left + i % 8, c) / 64.;
      const float first = at(made.data(), top, left, c);
      EXPECT_NEAR(first, mean, .125 + 1e-5);
      for (int i = 0; i < 64; ++i) {
        EXPECT_NEAR(at(made.data(), top + i / 8, left + i % 8, c), first, 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace ps::models
