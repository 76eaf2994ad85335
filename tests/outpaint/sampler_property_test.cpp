// SPDX-License-Identifier: BSD-3-Clause
// The sampler against whole forwards and against itself: any weights, orders, masks and numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "libps/core/parallel.h"
#include "libps/outpaint/sampler.h"
#include "tests/io/support.h"
#include "tests/outpaint/support.h"

namespace ps::outpaint {
namespace {

using models::PixelCnn;

/// Draws three completions; the logits that each cell was drawn from are those of a whole forward
/// over the completion's codes.
void expect_equal_to_full_forwards(const PixelCnn& network, const Order& order,
                                   const std::vector<std::int32_t>& codes, std::uint64_t seed) {
  constexpr int kCompletions = 3;
  Logits logits;
  SampleOptions options;
  options.seed = seed;
  options.observe = logits.observer(network.codes());
  const auto completions = Sampler(network, order, codes).sample(0, kCompletions, options);
  ASSERT_EQ(completions.size(), 3u);
  nn::Workspace workspace;
  nn::Tensor full({1, order.height, order.width, network.codes()});
  for (int k = 0; k < kCompletions; ++k) {
    network.forward(completions[static_cast<std::size_t>(k)].codes.data(), order.masks, full,
                    workspace);
    for (std::size_t cell = 0; cell < order.size(); ++cell) {
      const std::vector<float>& got = logits.of(static_cast<int>(cell), k);
      ASSERT_EQ(got.size(), order.missing[cell] ? static_cast<std::size_t>(network.codes()) : 0);
      for (std::size_t i = 0; i < got.size(); ++i) {
        ASSERT_NEAR(got[i], full.view().pixel(cell)[i], 1e-4) << "completion " << k;
      }
    }
  }
}

class SamplerOfRandomWeights : public testing::TestWithParam<int> {};

TEST_P(SamplerOfRandomWeights, gives_the_logits_of_full_forwards_for_any_order_and_mask) {
  const int width = GetParam();
  for (unsigned seed = 0; seed < 4; ++seed) {
    const PixelCnn network(shuffled(models::random_pixel_cnn(width, 24), seed));
    std::mt19937 random(100 * seed + static_cast<unsigned>(width));
    for (const double share : {0.1, 0.5, 0.9, 1.0}) {
      const int rows = 1 + static_cast<int>(random() % 11),
                columns = 1 + static_cast<int>(random() % 11);
      const Order order = random_order(random, rows, columns, share);
      SCOPED_TRACE(std::to_string(rows) + "x" + std::to_string(columns) + ", missing " +
                   std::to_string(share) + ", weights " + std::to_string(seed));
      expect_equal_to_full_forwards(network, order, random_codes(random, order.size(), 24), seed);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(widths, SamplerOfRandomWeights, testing::Values(1, 8, 11, 16, 24),
                         testing::PrintToStringParamName());

/// Background masks of 96x128 pixels: 12x16 cells.
struct Mask {
  const char* name;
  std::size_t missing;  ///< cells
  void (*draw)(cv::Mat1b& background);
};
void PrintTo(const Mask& mask, std::ostream* out) { *out << mask.name; }

const Mask kMasks[] = {
    {"everything_missing", 192, [](cv::Mat1b& b) { b = 1; }},
    {"one_cell_missing", 1, [](cv::Mat1b& b) { b(cv::Rect(40, 24, 8, 8)) = 1; }},
    {"a_corner_missing", 1, [](cv::Mat1b& b) { b(cv::Rect(0, 0, 8, 8)) = 1; }},
    {"one_cell_known", 191,
     [](cv::Mat1b& b) {
       b = 1;
       b(cv::Rect(64, 48, 8, 8)) = 0;
     }},
    {"an_island_known_in_what_is_missing", 135,
     [](cv::Mat1b& b) {
       b(cv::Rect(32, 0, 96, 96)) = 1;
       b(cv::Rect(80, 40, 24, 24)) = 0;
     }},
    {"only_islands_known", 175,
     [](cv::Mat1b& b) {
       b = 1;
       b(cv::Rect(8, 8, 32, 16)) = 0;
       b(cv::Rect(80, 40, 24, 24)) = 0;
     }},
    {"a_ring_missing", 72,
     [](cv::Mat1b& b) {
       b(cv::Rect(16, 16, 96, 64)) = 1;
       b(cv::Rect(40, 32, 48, 32)) = 0;
     }},
    {"a_rim_missing", 52,
     [](cv::Mat1b& b) {
       b = 1;
       b(cv::Rect(8, 8, 112, 80)) = 0;
     }},
};

class SamplerOfMasks : public testing::TestWithParam<Mask> {};

TEST_P(SamplerOfMasks, gives_the_logits_of_full_forwards) {
  cv::Mat1b background(96, 128, std::uint8_t{0});
  GetParam().draw(background);
  const Order order = order_of(background);
  const PixelCnn network = small_network();
  std::mt19937 random(9);
  std::vector<std::int32_t> codes = random_codes(random, order.size(), network.codes());
  for (std::size_t cell = 0; cell < order.size(); ++cell) {
    if (order.missing[cell]) codes[cell] = -1;  // not to be read
  }
  EXPECT_EQ(Sampler(network, order, codes).missing(), GetParam().missing);
  expect_equal_to_full_forwards(network, order, codes, 3);
}

INSTANTIATE_TEST_SUITE_P(cases, SamplerOfMasks, testing::ValuesIn(kMasks),
                         [](const auto& test) { return std::string(test.param.name); });

void expect_same(const Completion& a, const Completion& b) {
  EXPECT_EQ(a.codes, b.codes);
  EXPECT_EQ(a.log_likelihood, b.log_likelihood);
}

TEST(Sampler, many_completions_equal_single_ones_bit_by_bit_on_any_number_of_threads) {
  std::mt19937 random(12);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 6, 9, 0.6);
  const auto codes = random_codes(random, order.size(), network.codes());
  constexpr int kCompletions = 75;  // more lanes than threads, and of different sizes
  std::vector<Completion> singles;
  Sampler single(network, order, codes);
  for (int k = 0; k < kCompletions; ++k) singles.push_back(single.sample(k, 1).at(0));
  for (const int threads : {1, 2, 3, 8}) {
    set_threads(threads);
    const auto all = Sampler(network, order, codes).sample(0, kCompletions);
    ASSERT_EQ(all.size(), singles.size());
    for (std::size_t k = 0; k < all.size(); ++k) expect_same(all[k], singles[k]);
  }
  set_threads(0);
}

TEST(Sampler, a_thousand_completions_take_no_more_memory_than_fifty) {
  set_threads(1);  // of two, one may come too late to take any
  std::mt19937 random(13);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 5, 5, 0.5);
  const auto codes = random_codes(random, order.size(), network.codes());
  Sampler fifty(network, order, codes), thousand(network, order, codes);
  const auto some = fifty.sample(0, 50);
  const auto all = thousand.sample(0, 1000);
  ASSERT_EQ(all.size(), 1000u);
  for (std::size_t k = 0; k < some.size(); ++k) expect_same(all[k], some[k]);
  expect_same(all[999], fifty.sample(999, 1).at(0));
  EXPECT_LE(thousand.bytes(), fifty.bytes() * 5 / 4);  // a lane may hold fewer there, up to 16 here
  set_threads(0);
}

/// Memory is in proportion to the width, but for the logits, which this counts ten times.
TEST(Sampler, fifty_completions_of_a_view_take_under_a_gibibyte_at_the_published_width) {
  set_threads(2);
  const PixelCnn narrow(models::random_pixel_cnn(8));
  cv::Mat1b background(256, 256, std::uint8_t{0});
  background(cv::Rect(256 - 120, 0, 120, 256)) = 1;  // 480 cells
  const Order side = order_of(background), all = order_of(cv::Mat1b(256, 256, std::uint8_t{1}));
  for (const Order* order : {&side, &all}) {
    Sampler sampler(narrow, *order, std::vector<std::int32_t>(1024, 0));
    sampler.sample(0, 50);
    const double mib = 10.0 * static_cast<double>(sampler.bytes()) / (1 << 20);
    std::printf("%zu missing cells, 50 completions: at most %.0f MiB\n", sampler.missing(), mib);
    EXPECT_GT(mib, 10);
    EXPECT_LT(mib, 1024);
  }
  set_threads(0);
}

TEST(Sampler, the_least_temperatures_draw_what_greedy_takes) {
  std::mt19937 random(14);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 7, 7, 0.7);
  const auto codes = random_codes(random, order.size(), network.codes());
  Sampler sampler(network, order, codes);
  SampleOptions options;
  options.temperature = 0;
  const Completion greedy = sampler.sample(0, 1, options).at(0);
  for (const double temperature : {1e-5, 1e-30, 1e-44, 1e-300}) {
    options.temperature = temperature;
    const auto completions = sampler.sample(0, 3, options);
    ASSERT_EQ(completions.size(), 3u);
    for (const Completion& drawn : completions) expect_same(drawn, greedy);
  }
  options.temperature = 2;
  EXPECT_NE(sampler.sample(0, 1, options).at(0).codes, greedy.codes);
}

TEST(Sampler, weights_that_are_not_numbers_or_overflow_are_errors_that_name_the_place) {
  const nn::Weights weights = models::random_pixel_cnn(8, 24);
  const std::string name = "outpaint2.up_layers.1.u_stream.0.conv_input.weight";
  EXPECT_TRUE(has(error_of([&] { PixelCnn(with_all(weights, name, std::nanf(""))); }), name));
  const PixelCnn network(with_all(weights, name, 1e38f));
  const Order order = order_from(1, 3, {0, 1, 2}, {0, 1, 1});
  for (const int threads : {1, 2}) {
    set_threads(threads);
    const std::string error = error_of([&] { Sampler(network, order, {3, 0, 0}).sample(7, 4); });
    EXPECT_TRUE(has(error, "of cell 1 (row 0, column 1) of completion 7")) << error;
  }
  set_threads(0);
}

TEST(Sampler, progress_rises_from_0_to_1_and_stops_at_once_on_any_number_of_threads) {
  std::mt19937 random(3);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 8, 8, 0.7);
  Sampler sampler(network, order, random_codes(random, order.size(), network.codes()));
  for (const int threads : {1, 2, 4}) {
    set_threads(threads);
    std::vector<double> told;
    SampleOptions options;
    options.progress = [&](double done) {  // one call at a time
      told.push_back(done);
      return true;
    };
    const auto whole = sampler.sample(0, 40, options);
    EXPECT_EQ(whole.size(), 40u);
    EXPECT_EQ(told.front(), 0);
    EXPECT_EQ(told.back(), 1);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    for (const std::size_t calls : {std::size_t{1}, told.size() / 2, told.size()}) {
      std::size_t called = 0;
      options.progress = [&](double) { return ++called < calls; };
      EXPECT_TRUE(sampler.sample(0, 40, options).empty());
      EXPECT_EQ(called, calls) << "called again after it said stop";
    }
    options.progress = [](double done) -> bool {
      if (done > 0.3) throw Error("progress", "interrupted");
      return true;
    };
    EXPECT_TRUE(has(error_of([&] { sampler.sample(0, 40, options); }), "interrupted"));
    expect_same(sampler.sample(39, 1).at(0), whole[39]);  // and it can go on
  }
  set_threads(0);
}

}  // namespace
}  // namespace ps::outpaint
