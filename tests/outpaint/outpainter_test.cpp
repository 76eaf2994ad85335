// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <numeric>

#include "libps/core/parallel.h"
#include "tests/io/support.h"
#include "tests/outpaint/outpainter_fixture.h"
#include "tests/outpaint/support.h"

namespace ps::outpaint {
namespace {

TEST_F(OutpainterOfRandomWeights, a_part_of_the_view_gives_what_the_whole_view_gives) {
  OutpaintOptions options;
  options.samples = 4;
  options.seed = 5;
  options.guidance = 0;
  SampleOptions as_drawn;
  as_drawn.seed = 5;
  const auto completions =
      Sampler(pixel_cnn_, order_of(background_), known_codes()).sample(0, 4, as_drawn);
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

TEST_F(OutpainterOfRandomWeights, cells_seen_in_part_continue_what_is_seen_unless_told_otherwise) {
  OutpaintOptions options;
  options.samples = 1;
  const Order order = order_of(background_);
  const auto known = [&](std::vector<std::int32_t> codes) {
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] *= order.missing[i] == 0;
    return codes;
  };
  const auto used = [&] {
    return known(outpainter({}).run(projection_, background_, options).codes);
  };
  EXPECT_EQ(used(), known(known_codes()));
  options.encode_nearest = false;
  EXPECT_EQ(used(), known(codes_of(projection_)));
  EXPECT_NE(known(known_codes()), known(codes_of(projection_)));
}

/// The more of it, the nearer to the codes of the nearest seen colours; at its end, those alone.
TEST_F(OutpainterOfRandomWeights, guidance_holds_completions_to_the_nearest_seen_colours) {
  OutpaintOptions options;
  options.samples = 1;
  options.temperature = 1;
  const auto nearest = known_codes();
  const auto equal = [&](double guidance) {
    options.guidance = guidance;
    const auto codes = outpainter({}).run(projection_, background_, options).codes;
    return std::inner_product(codes.begin(), codes.end(), nearest.begin(), std::size_t{0},
                              std::plus<>(), std::equal_to<>());
  };
  const std::size_t none = equal(0), some = equal(5), all = equal(1000);
  EXPECT_LT(none, some);
  EXPECT_LE(some, all);
  EXPECT_GE(all, nearest.size() - 1);  // two codes may be as near
}

/// Against the rule as it is written, distance by distance.
TEST_F(OutpainterOfRandomWeights, guidance_falls_with_the_squared_distance_in_spacings) {
  const nn::Tensor whole = with_nearest_colors(projection_.view(), background_);
  nn::Tensor seen(autoencoder_.grid(whole.shape()));
  autoencoder_.encode(whole, seen, workspace_);
  std::vector<std::int32_t> all(static_cast<std::size_t>(autoencoder_.codes()));
  std::iota(all.begin(), all.end(), 0);
  nn::Tensor vectors({1, 1, autoencoder_.codes(), autoencoder_.channels()});
  autoencoder_.codebook().embed(all.data(), vectors);
  const auto squared = [&](const float* a, const float* b) {
    double sum = 0;
    for (int c = 0; c < autoencoder_.channels(); ++c) sum += std::pow(double{a[c]} - b[c], 2);
    return sum;
  };
  std::vector<double> spacings;
  for (const auto k : all) {
    double least = 1e9;
    for (const auto other : all) {
      const auto i = static_cast<std::size_t>(k), j = static_cast<std::size_t>(other);
      if (i != j)
        least = std::min(least, squared(vectors.view().pixel(i), vectors.view().pixel(j)));
    }
    spacings.push_back(least);
  }
  std::sort(spacings.begin(), spacings.end());
  constexpr double kGuidance = 2;
  std::vector<float> guidance;
  for (std::size_t cell = 0; cell < seen.shape().pixels(); ++cell) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double far = squared(seen.view().pixel(cell), vectors.view().pixel(k));
      guidance.push_back(static_cast<float>(-kGuidance * far / spacings[spacings.size() / 2]));
    }
  }
  SampleOptions sampling;
  sampling.temperature = 1;
  sampling.guidance = guidance.data();
  const auto expected =
      Sampler(pixel_cnn_, order_of(background_), known_codes()).sample(0, 1, sampling)[0].codes;
  OutpaintOptions options;
  options.samples = 1;
  options.temperature = 1;
  options.guidance = kGuidance;
  EXPECT_EQ(outpainter({}).run(projection_, background_, options).codes, expected);
}

TEST_F(OutpainterOfRandomWeights, guidance_has_nothing_to_hold_to_where_nothing_is_seen) {
  background_ = 1;
  std::fill_n(projection_.data(), projection_.shape().pixels() * 3, 0.f);
  OutpaintOptions options;
  options.samples = 1;
  options.guidance = 0;
  const auto free = outpainter({}).run(projection_, background_, options).codes;
  options.guidance = 1000;
  EXPECT_EQ(outpainter({}).run(projection_, background_, options).codes, free);
}

TEST_F(OutpainterOfRandomWeights, completions_that_are_all_alike_are_drawn_once) {
  OutpaintOptions options;
  options.temperature = 0;
  options.samples = 5;
  const Outpainted result = outpainter({recorder()}).run(projection_, background_, options);
  EXPECT_EQ(result.report.drawn, 1);
  EXPECT_EQ(seen_.size(), 1u);
}

TEST_F(OutpainterOfRandomWeights, nothing_missing_costs_nothing) {
  background_ = 0;
  const Outpainted result = outpainter({recorder()}).run(projection_, background_, {});
  EXPECT_EQ(worst_difference(result.image, projection_), 0);
  EXPECT_EQ(result.report.drawn, 0);
  EXPECT_EQ(result.best, -1);
  EXPECT_TRUE(seen_.empty());
}

TEST_F(OutpainterOfRandomWeights, options_out_of_range_throw_even_where_nothing_is_missing) {
  background_ = 0;
  const auto message = [&](const OutpaintOptions& options) -> std::string {
    try {
      outpainter({recorder()}).run(projection_, background_, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  OutpaintOptions options;
  options.temperature = std::nan("");
  EXPECT_NE(message(options).find("temperature"), std::string::npos);
  options = {};
  options.samples = 1001;
  EXPECT_NE(message(options).find("1 to 1000"), std::string::npos);
  options = {};
  for (const double guidance : {-1.0, 1001.0, std::nan("")}) {
    options.guidance = guidance;
    EXPECT_NE(message(options).find("guidance"), std::string::npos) << guidance;
  }
  options = {};
  options.refine_best = -1;
  EXPECT_NE(message(options).find("completions to refine"), std::string::npos);
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

/// The paper's ablations: one completion, the classifier alone, the discriminator alone.
TEST_F(OutpainterOfRandomWeights, one_signal_alone_chooses_its_own_best) {
  OutpaintOptions options;
  options.samples = 6;
  const auto result_of = [&](std::vector<Scorer> scorers) {
    return outpainter(std::move(scorers)).run(projection_, background_, options);
  };
  const auto place = [](const std::vector<double>& scores, auto than) {
    return std::min_element(scores.begin(), scores.end(), than) - scores.begin();
  };
  const Outpainted realest = result_of({discriminator_scorer(discriminator_)});
  EXPECT_EQ(realest.best, place(realest.scores.at(0), std::greater<>()));
  const Outpainted surest = result_of({entropy_scorer(classifier_)});
  EXPECT_EQ(surest.best, place(surest.scores.at(0), std::less<>()));
  EXPECT_NE(realest.scores, surest.scores);
  options.samples = 1;
  EXPECT_EQ(result_of({discriminator_scorer(discriminator_)}).best, 0);
}

TEST_F(OutpainterOfRandomWeights, without_scorers_one_is_kept_by_its_codes_and_refined_alone) {
  const auto completions = Sampler(pixel_cnn_, order_of(background_), known_codes()).sample(0, 40);
  using Keep = OutpaintOptions::Keep;
  const auto best_of_first = [&](int count, Keep keep) {
    const std::vector<Completion> drawn(completions.begin(), completions.begin() + count);
    std::vector<double> scores = agreement(drawn);
    for (std::size_t i = 0; keep == Keep::likeliest && i < scores.size(); ++i) {
      scores[i] = drawn[i].log_likelihood;
    }
    return static_cast<int>(best_of(scores));
  };
  OutpaintOptions options;
  options.guidance = 0;
  for (const Keep keep : {Keep::agreed, Keep::likeliest}) {
    for (const bool until_settled : {false, true}) {
      for (const int samples : {1, 9, 40}) {
        options.keep = keep;
        options.samples = samples;
        options.until_settled = until_settled;
        const Outpainted result = outpainter({}).run(projection_, background_, options);
        const int best = best_of_first(result.report.drawn, keep);
        EXPECT_EQ(result.best, best) << samples;
        EXPECT_EQ(result.refined, std::vector<int>{best}) << samples;
        EXPECT_EQ(result.codes, completions[static_cast<std::size_t>(best)].codes) << samples;
        EXPECT_EQ(worst_difference(result.image, refined_whole(result.codes, options)), 0);
        EXPECT_TRUE(until_settled || result.report.drawn == samples);
      }
    }
  }
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
  options.guidance = 0;
  options.samples = 10;
  options.refine_best = 3;
  options.screen = OutpaintOptions::Screen::likelihood;
  const Outpainted result = outpainter({recorder()}).run(projection_, background_, options);
  EXPECT_EQ(seen_.size(), 3u);
  EXPECT_EQ(result.report.drawn, 10);
  EXPECT_EQ(result.report.refined, 3);
  const auto completions = Sampler(pixel_cnn_, order_of(background_), known_codes()).sample(0, 10);
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

/// What each completion that was refined looks like to every signal, whatever else was refined.
TEST_F(OutpainterOfRandomWeights, scores_are_the_same_bytes_whichever_others_are_refined) {
  Outpainter painter =
      outpainter({discriminator_scorer(discriminator_), entropy_scorer(classifier_), recorder()});
  OutpaintOptions options;
  options.samples = 9;
  options.likelihood = true;
  const Outpainted all = painter.run(projection_, background_, options);
  const std::vector<nn::Tensor> pictures = std::move(seen_);
  const auto expect_the_same = [&] {
    seen_.clear();
    const Outpainted some = painter.run(projection_, background_, options);
    const std::size_t unrefined = seen_.size() - some.refined.size();  // those come first
    for (std::size_t i = 0; i < some.refined.size(); ++i) {
      const auto number = static_cast<std::size_t>(some.refined[i]);
      for (std::size_t signal = 0; signal < all.scores.size(); ++signal) {
        EXPECT_EQ(some.scores[signal][i], all.scores[signal][number]) << number;
      }
      EXPECT_EQ(worst_difference(seen_[unrefined + i], pictures[number]), 0) << number;
      if (some.refined[i] == some.best) {
        EXPECT_EQ(worst_difference(some.image, pictures[number]), 0);
      }
    }
    return some.refined;
  };
  EXPECT_EQ(expect_the_same().size(), 9u);
  options.refine_best = 3;
  EXPECT_EQ(expect_the_same().size(), 3u);
  options.screen = OutpaintOptions::Screen::likelihood;
  EXPECT_GT(expect_the_same().front(), -1);
  options.refine_best = 1;
  EXPECT_EQ(expect_the_same().size(), 1u);
  options.refine_best = 0;
  options.samples = 1;
  EXPECT_EQ(expect_the_same(), std::vector<int>{0});
  options.samples = 9;
  options.until_settled = true;
  EXPECT_GE(expect_the_same().size(), 8u);
}

TEST_F(OutpainterOfRandomWeights, with_the_region_off_the_same_comes_of_whole_pictures) {
  OutpaintOptions options;
  options.samples = 3;
  Outpainter painter = outpainter({recorder({0, 2, 1})});
  const Outpainted part = painter.run(projection_, background_, options);
  options.region = false;
  const Outpainted whole = painter.run(projection_, background_, options);
  EXPECT_EQ(whole.report.changed, cv::Rect(0, 0, kWidth, kHeight));
  ASSERT_EQ(seen_.size(), 6u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LE(worst_difference(seen_[i], seen_[3 + i]), 1e-4);
  }
  EXPECT_EQ(part.codes, whole.codes);
  EXPECT_LE(worst_difference(whole.image, refined_whole(whole.codes, options)), 0);
}

TEST_F(OutpainterOfRandomWeights, everything_may_be_missing) {
  background_ = 1;
  std::fill_n(projection_.data(), projection_.shape().pixels() * 3, 0.0f);
  OutpaintOptions options;
  options.samples = 2;
  const Outpainted result =
      outpainter({discriminator_scorer(discriminator_)}).run(projection_, background_, options);
  EXPECT_EQ(result.report.missing_cells, static_cast<std::size_t>(kHeight / 8 * kWidth / 8));
  EXPECT_LE(worst_difference(result.image, refined_whole(result.codes, options)), 0);
}

TEST_F(OutpainterOfRandomWeights, values_that_are_not_finite_are_errors_that_name_the_completion) {
  OutpaintOptions options;
  options.samples = 4;
  Outpainter painter =
      outpainter({discriminator_scorer(discriminator_), recorder({0, 1, std::nan(""), 0})});
  const std::string score = error_of([&] { painter.run(projection_, background_, options); });
  EXPECT_TRUE(has(score, "score of completion 2 by recorder is not a number")) << score;
  const models::Refiner overflowing(
      with_all(models::random_refiner(8), "projector.eblocks.0.ch_a.2.weight", 1e38f));
  Outpainter other({&autoencoder_, &pixel_cnn_, &overflowing, {recorder()}});
  const std::string picture = error_of([&] { other.run(projection_, background_, options); });
  EXPECT_TRUE(has(picture, "picture of completion 0")) << picture;
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
