// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/codebook.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

double distance(const float* x, const WeightTensor& embed, std::int32_t code) {
  double sum = 0;
  for (std::size_t c = 0; c < embed.shape[0]; ++c) {
    const double d = x[c] - embed.values[c * embed.shape[1] + static_cast<std::size_t>(code)];
    sum += d * d;
  }
  return sum;
}

TEST(Codebook, nearest_is_the_reference_save_for_ties) {
  Random random(41);
  for (int i = 0; i < 100; ++i) {
    const int channels = random.channels();
    const WeightTensor embed =
        random.weights({channels, random.pick({1, 2, 3, 15, 16, 17, 65, 512})});
    Shape shape = random.shape(channels);
    shape.channels = channels;  // never none
    const Slice in(shape, random.pick({0, 0, 5}), random);
    const std::vector<std::int32_t> expected =
        reference::nearest_codes(reference::Values(in), embed);
    on_every_isa([&] {
      const Codebook codebook(embed);
      std::vector<std::int32_t> codes(shape.pixels());
      codebook.nearest(in, codes.data());
      for (std::size_t p = 0; p < codes.size(); ++p) {
        if (codes[p] == expected[p]) continue;
        const float* x = in.view().pixel(p);
        EXPECT_LT(distance(x, embed, codes[p]), distance(x, embed, expected[p]) + 1e-4);
      }
    });
  }
}

TEST(Codebook, of_equal_codes_the_first_wins) {
  Random random(42);
  WeightTensor embed = random.weights({7, 40});
  for (std::size_t c = 0; c < 7; ++c) {  // the second half repeats the first
    for (std::size_t k = 0; k < 20; ++k) embed.values[c * 40 + 20 + k] = embed.values[c * 40 + k];
  }
  const Slice in({1, 10, 10, 7}, 0, random);
  on_every_isa([&] {
    std::vector<std::int32_t> codes(100);
    Codebook(embed).nearest(in, codes.data());
    for (const std::int32_t code : codes) EXPECT_LT(code, 20);
  });
}

TEST(Codebook, embeddings_are_those_given_and_find_themselves) {
  Random random(43);
  const WeightTensor embed = random.weights({33, 100});
  const Codebook codebook(embed);
  EXPECT_EQ(codebook.size(), 100);
  EXPECT_EQ(codebook.channels(), 33);
  std::vector<std::int32_t> codes(100), found(100);
  for (std::int32_t k = 0; k < 100; ++k) codes[static_cast<std::size_t>(k)] = (k * 37 + 5) % 100;
  const Slice out({1, 4, 25, 33}, 2);
  codebook.embed(codes.data(), out);
  EXPECT_TRUE(out.margins_untouched());
  for (std::size_t p = 0; p < 100; ++p)
    EXPECT_EQ(distance(out.view().pixel(p), embed, codes[p]), 0);
  codebook.nearest(out, found.data());
  EXPECT_EQ(found, codes);
}

TEST(Codebook, excess_is_the_squared_distance_beyond_the_nearest) {
  Random random(44);
  const WeightTensor embed = random.weights({9, 21});
  const Slice in({1, 3, 5, 9}, 1, random);
  on_every_isa([&] {
    const Codebook codebook(embed);
    std::vector<float> excess(15 * 21);
    std::vector<std::int32_t> nearest(15);
    codebook.excess(in, excess.data());
    codebook.nearest(in, nearest.data());
    for (std::size_t p = 0; p < 15; ++p) {
      const float* x = in.view().pixel(p);
      for (std::int32_t k = 0; k < 21; ++k) {
        EXPECT_NEAR(excess[p * 21 + static_cast<std::size_t>(k)],
                    distance(x, embed, k) - distance(x, embed, nearest[p]), 1e-4);
      }
    }
  });
}

TEST(Codebook, spacing_is_the_median_squared_distance_to_the_nearest_other) {
  // On a line: 0, 2, 5, 9, 14, so that the nearest other is 2, 2, 3, 4, 5 away.
  const WeightTensor embed = {{2, 5}, {0, 2, 5, 9, 14, 7, 7, 7, 7, 7}};
  EXPECT_NEAR(Codebook(embed).spacing(), 9, 1e-4);
  EXPECT_EQ(Codebook({{3, 1}, {1, 2, 3}}).spacing(), 0);
}

TEST(Codebook, refuses_misfit_shapes_and_codes) {
  Random random(44);
  const Codebook codebook(random.weights({4, 10}));
  const Tensor wide({1, 1, 2, 5}), fits({1, 1, 2, 4});
  std::vector<std::int32_t> codes = {0, 9};
  EXPECT_THROW(codebook.nearest(wide, codes.data()), Error);
  EXPECT_THROW(codebook.embed(codes.data(), wide), Error);
  EXPECT_NO_THROW(codebook.embed(codes.data(), fits));
  for (const std::int32_t wrong : {-1, 10}) {
    codes[1] = wrong;
    EXPECT_THROW(codebook.embed(codes.data(), fits), Error);
  }
  EXPECT_THROW(Codebook(random.weights({4})), Error);
  EXPECT_THROW(Codebook(random.weights({4, 0})), Error);
}

}  // namespace
}  // namespace ps::nn
