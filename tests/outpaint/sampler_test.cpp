// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "io/safetensors.h"
#include "libps/core/parallel.h"
#include "tests/io/support.h"
#include "tests/models/support.h"
#include "tests/outpaint/support.h"

namespace ps::outpaint {
namespace {

using models::bytes_of;
using models::ints_of;
using models::PixelCnn;

Order order_of_pairs(const FileTensor& pairs, const FileTensor& missing) {
  const auto values = ints_of(pairs);
  std::vector<int> cells;
  for (std::size_t i = 0; i < values.size(); i += 2)
    cells.push_back(values[i] * 32 + values[i + 1]);
  return order_from(32, 32, cells, bytes_of(missing));
}

TEST(Sampler, greedy_equals_the_published_code_token_for_token) {
  PS_NEED_SHARED("reference/h_greedy.safetensors");
  const TensorMap all = read_safetensors(shared("reference/h_greedy.safetensors"));
  const PixelCnn network(models::reference_weights());
  Sampler sampler(network, order_of_pairs(all.at("order"), all.at("missing32")),
                  ints_of(all.at("codes_in")));
  SampleOptions options;
  options.temperature = 0;
  const auto tokens = ints_of(all.at("tokens"));
  const auto completions = sampler.sample(0, 3, options);
  ASSERT_EQ(completions.size(), 3u);
  for (const Completion& completion : completions) {
    EXPECT_EQ(completion.codes, ints_of(all.at("codes_out")));
    for (std::size_t i = 0; i < tokens.size(); i += 3) {
      EXPECT_EQ(completion.codes[static_cast<std::size_t>(tokens[i] * 32 + tokens[i + 1])],
                tokens[i + 2]);
    }
  }
}

TEST(Sampler, teacher_forcing_reproduces_the_published_logits) {
  PS_NEED_SHARED("reference/h_greedy.safetensors");
  const TensorMap all = read_safetensors(shared("reference/h_greedy.safetensors"));
  const PixelCnn network(models::reference_weights());
  Sampler sampler(network, order_of_pairs(all.at("order"), all.at("missing32")),
                  ints_of(all.at("codes_in")));
  const auto forced = ints_of(all.at("codes_out"));
  Logits logits;
  SampleOptions options;
  options.forced = forced.data();
  options.observe = logits.observer(512);
  sampler.sample(0, 1, options);
  const auto tokens = ints_of(all.at("tokens"));
  const std::vector<float> expected = all.at("step_logits").as_floats();
  double worst = 0;
  for (std::size_t i = 0; i < tokens.size() / 3; ++i) {
    const auto& got = logits.of(tokens[3 * i] * 32 + tokens[3 * i + 1]);
    ASSERT_EQ(got.size(), 512u);
    for (std::size_t k = 0; k < 512; ++k) {
      const double difference = std::abs(got[k] - expected[512 * i + k]);
      if (!(difference <= worst)) worst = difference;  // also when it is NaN
    }
  }
  std::printf("worst difference of step_logits: %.2g\n", worst);
  EXPECT_LE(worst, 5e-3);
}

TEST(Sampler, greedy_and_its_logits_equal_their_golden) {
  const TensorMap& golden = models::goldens();
  const PixelCnn network(models::golden_weights());
  Sampler sampler(network, order_of_pairs(golden.at("greedy.order"), golden.at("greedy.missing32")),
                  ints_of(golden.at("greedy.codes_in")));
  Logits logits;
  SampleOptions options;
  options.temperature = 0;
  options.observe = logits.observer(network.codes());
  EXPECT_EQ(sampler.sample(0, 1, options)[0].codes, ints_of(golden.at("greedy.codes_out")));
  const auto steps = ints_of(golden.at("greedy.steps"));
  const std::vector<float> expected = golden.at("greedy.step_logits").as_floats();
  const auto codes = static_cast<std::size_t>(network.codes());
  ASSERT_EQ(expected.size(), steps.size() / 2 * codes);
  for (std::size_t i = 0; i < steps.size() / 2; ++i) {
    const auto& got = logits.of(steps[2 * i] * 32 + steps[2 * i + 1]);
    for (std::size_t k = 0; k < codes; ++k) ASSERT_NEAR(got[k], expected[i * codes + k], 5e-3);
  }
}

TEST(Sampler, a_completion_does_not_depend_on_how_many_are_drawn_or_on_threads) {
  std::mt19937 random(21);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 9, 7, 0.5);
  const auto codes = random_codes(random, order.size(), network.codes());
  SampleOptions options;
  options.seed = 77;
  const auto all = Sampler(network, order, codes).sample(0, 13, options);
  for (const int threads : {1, 2, 3}) {
    set_threads(threads);
    Sampler sampler(network, order, codes);
    for (const auto& [first, count] : {std::pair(0, 1), std::pair(1, 5), std::pair(6, 7)}) {
      const auto some = sampler.sample(first, count, options);
      ASSERT_EQ(some.size(), static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) {
        const Completion& whole = all[static_cast<std::size_t>(first + i)];
        EXPECT_EQ(some[static_cast<std::size_t>(i)].codes, whole.codes);
        EXPECT_EQ(some[static_cast<std::size_t>(i)].log_likelihood, whole.log_likelihood);
      }
    }
  }
  set_threads(0);
}

TEST(Sampler, keeps_what_is_known_and_draws_different_completions) {
  std::mt19937 random(2);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 8, 8, 0.6);
  const auto codes = random_codes(random, order.size(), network.codes());
  SampleOptions options;
  options.temperature = 2;
  const auto completions = Sampler(network, order, codes).sample(0, 4, options);
  for (const Completion& completion : completions) {
    for (std::size_t cell = 0; cell < order.size(); ++cell) {
      if (!order.missing[cell]) {
        EXPECT_EQ(completion.codes[cell], codes[cell]);
      }
      EXPECT_GE(completion.codes[cell], 0);
      EXPECT_LT(completion.codes[cell], network.codes());
    }
    EXPECT_LT(completion.log_likelihood, 0);
  }
  EXPECT_NE(completions[0].codes, completions[1].codes);
  options.view = 1;
  EXPECT_NE(Sampler(network, order, codes).sample(0, 1, options)[0].codes, completions[0].codes);
}

/// One missing cell: what is drawn follows softmax((logits + guidance) / T), and what is told of
/// the logits is without the guidance.
TEST(Sampler, draws_follow_the_softmax_at_every_temperature) {
  std::mt19937 random(5);
  const PixelCnn network = small_network();
  std::vector<std::uint8_t> missing(9, 0);
  missing[4] = 1;
  const Order order = order_from(3, 3, {0, 1, 2, 3, 5, 6, 7, 8, 4}, missing);
  const auto codes = random_codes(random, 9, network.codes());
  std::vector<float> guidance(9 * static_cast<std::size_t>(network.codes()));
  for (float& g : guidance) g = std::uniform_real_distribution<float>(-1, 0)(random);
  const auto width = static_cast<std::size_t>(network.codes());
  std::vector<float> alone;
  for (const auto& [temperature, share_of_guidance] :
       {std::pair(0.5, 0), {1.0, 0}, {2.0, 0}, {0.5, 1}, {2.0, 1}}) {
    constexpr int kDraws = 20000;
    Logits logits;
    SampleOptions options;
    options.temperature = temperature;
    if (share_of_guidance > 0) options.guidance = guidance.data();
    options.observe = logits.observer(network.codes());
    std::vector<double> share(static_cast<std::size_t>(network.codes()), 0), expected = share;
    for (const Completion& completion : Sampler(network, order, codes).sample(0, kDraws, options)) {
      share[static_cast<std::size_t>(completion.codes[4])] += 1.0 / kDraws;
    }
    double sum = 0;
    for (std::size_t k = 0; k < share.size(); ++k) {
      expected[k] =
          std::exp((logits.of(4)[k] + share_of_guidance * guidance[4 * width + k]) / temperature);
      sum += expected[k];
    }
    for (std::size_t k = 0; k < share.size(); ++k) EXPECT_NEAR(share[k], expected[k] / sum, 0.015);
    const std::vector<float> told = logits.of(4);
    if (alone.empty()) alone = told;
    EXPECT_EQ(told, alone);
  }
}

TEST(Sampler, log_likelihood_of_what_guidance_chose_is_the_networks_opinion) {
  std::mt19937 random(8);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 8, 8, 0.6);
  const auto codes = random_codes(random, order.size(), network.codes());
  const auto width = static_cast<std::size_t>(network.codes());
  const auto wanted = random_codes(random, order.size(), network.codes());
  std::vector<float> guidance(order.size() * width, -1e4f);
  for (std::size_t i = 0; i < order.size(); ++i) {
    guidance[i * width + static_cast<std::size_t>(wanted[i])] = 0;
  }
  for (const double temperature : {0.0, 1.0}) {
    SampleOptions options;
    options.temperature = temperature;
    const auto free = Sampler(network, order, codes).sample(0, 1, options)[0];
    const std::vector<float> none(guidance.size(), 0);
    options.guidance = none.data();
    EXPECT_EQ(Sampler(network, order, codes).sample(0, 1, options)[0].codes, free.codes);
    options.guidance = guidance.data();
    const auto guided = Sampler(network, order, codes).sample(0, 1, options)[0];
    for (std::size_t i = 0; i < order.size(); ++i) {
      EXPECT_EQ(guided.codes[i], order.missing[i] ? wanted[i] : codes[i]);
    }
    options.guidance = nullptr;
    options.forced = wanted.data();
    EXPECT_EQ(guided.log_likelihood,
              Sampler(network, order, codes).sample(0, 1, options)[0].log_likelihood);
  }
}

TEST(Sampler, log_likelihood_is_the_mean_over_missing_cells) {
  std::mt19937 random(6);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 5, 6, 0.5);
  Logits logits;
  SampleOptions options;
  options.observe = logits.observer(network.codes());
  const auto completion =
      Sampler(network, order, random_codes(random, order.size(), network.codes()))
          .sample(0, 1, options)[0];
  double sum = 0;
  int count = 0;
  for (std::size_t cell = 0; cell < order.size(); ++cell) {
    if (!order.missing[cell]) continue;
    double whole = 0;
    const std::vector<float>& of_cell = logits.of(static_cast<int>(cell));
    for (const float logit : of_cell) whole += std::exp(logit);
    sum += of_cell[static_cast<std::size_t>(completion.codes[cell])] - std::log(whole);
    ++count;
  }
  EXPECT_NEAR(completion.log_likelihood, sum / count, 1e-5);
}

TEST(Sampler, nothing_missing_costs_nothing) {
  std::mt19937 random(1);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 6, 6, 0);
  const auto codes = random_codes(random, order.size(), network.codes());
  Sampler sampler(network, order, codes);
  EXPECT_EQ(sampler.missing(), 0u);
  EXPECT_EQ(sampler.levels(), 0u);
  const auto completions = sampler.sample(0, 2);
  ASSERT_EQ(completions.size(), 2u);
  EXPECT_EQ(completions[1].codes, codes);
  EXPECT_EQ(completions[1].log_likelihood, 0);
  EXPECT_TRUE(sampler.sample(0, 0).empty());
}

TEST(Sampler, stops_when_it_is_told_to) {
  std::mt19937 random(3);
  const PixelCnn network = small_network();
  const Order order = random_order(random, 8, 8, 0.7);
  Sampler sampler(network, order, random_codes(random, order.size(), network.codes()));
  double last = -1;
  SampleOptions options;
  options.progress = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return done < 0.5;
  };
  EXPECT_TRUE(sampler.sample(0, 2, options).empty());
  EXPECT_LT(last, 1);
  options.progress = [&](double done) {
    last = done;
    return true;
  };
  EXPECT_EQ(sampler.sample(0, 2, options).size(), 2u);
  EXPECT_EQ(last, 1);
}

TEST(Sampler, errors_say_what_is_wrong) {
  const PixelCnn network = small_network();
  const Order order = order_from(1, 2, {0, 1}, {0, 1});
  EXPECT_TRUE(has(error_of([&] { Sampler(network, order, {0}); }), "1 codes"));
  EXPECT_TRUE(has(error_of([&] { Sampler(network, order, {24, 0}); }), "0 to 23"));
  EXPECT_TRUE(has(error_of([&] { Sampler(network, order, {-1, 0}); }), "cell 0"));
  Sampler sampler(network, order, {3, -1});
  SampleOptions options;
  EXPECT_TRUE(has(error_of([&] { sampler.sample(0, -1, options); }), "completions"));
  EXPECT_TRUE(has(error_of([&] { sampler.sample(-1, 1, options); }), "first completion"));
  EXPECT_TRUE(has(error_of([&] { sampler.sample(1, 0x7fffffff, options); }), "31 bits"));
  const double huge = std::numeric_limits<double>::infinity();
  for (const double temperature : {-0.1, 2.1, 1e30, huge, std::nan("")}) {
    options.temperature = temperature;
    EXPECT_TRUE(has(error_of([&] { sampler.sample(0, 1, options); }), "temperature"));
  }
  options.temperature = 1;
  const std::vector<std::int32_t> forced = {0, 24};
  options.forced = forced.data();
  EXPECT_TRUE(has(error_of([&] { sampler.sample(0, 1, options); }), "forced code of cell 1"));
}

}  // namespace
}  // namespace ps::outpaint
