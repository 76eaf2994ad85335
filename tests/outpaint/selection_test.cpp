// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/selection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/safetensors.h"
#include "tests/io/support.h"
#include "tests/models/support.h"

namespace ps::outpaint {
namespace {

std::vector<double> doubles_of(const FileTensor& tensor) {
  const std::vector<float> values = tensor.as_floats();
  return {values.begin(), values.end()};
}

TEST(Selection, equals_the_published_choice) {
  PS_NEED_SHARED("reference/j_select.safetensors");
  const TensorMap all = read_safetensors(shared("reference/j_select.safetensors"));
  const Signal discriminator = {doubles_of(all.at("D_Fake")), true};
  const Signal classifier = {doubles_of(all.at("entropy")), false};
  EXPECT_EQ(ranks(discriminator.scores), models::ints_of(all.at("disc_rank")));
  EXPECT_EQ(ranks(classifier.scores), models::ints_of(all.at("entropy_rank")));
  const std::vector<double> total = totals({discriminator, classifier});
  EXPECT_EQ(total, doubles_of(all.at("total")));
  EXPECT_EQ(static_cast<int>(best_of(total)), models::ints_of(all.at("best"))[0]);
  const std::vector<float> logits = all.at("logits").as_floats();
  for (std::size_t i = 0; i < classifier.scores.size(); ++i) {
    const std::vector<float> row(logits.begin() + static_cast<std::ptrdiff_t>(365 * i),
                                 logits.begin() + static_cast<std::ptrdiff_t>(365 * (i + 1)));
    EXPECT_NEAR(entropy(row), classifier.scores[i], 1e-4);
  }
}

TEST(Selection, one_signal_alone_chooses_its_own_best) {
  EXPECT_EQ(best_of(totals({{{3, 9, 4}, true}})), 1u);
  EXPECT_EQ(best_of(totals({{{3, 9, 4}, false}})), 0u);
}

TEST(Selection, of_equal_totals_the_first_wins) {
  EXPECT_EQ(best_of(totals({{{1, 2}, true}, {{1, 2}, false}})), 0u);
  EXPECT_EQ(ranks({5, 1, 5, 1}), (std::vector<int>{2, 0, 3, 1}));
}

TEST(Selection, entropy_is_known_for_even_and_for_certain) {
  EXPECT_NEAR(entropy(std::vector<float>(8, -3.f)), std::log(8.0), 1e-12);
  EXPECT_NEAR(entropy({1000, 0, 0}), 0, 1e-12);
}

TEST(Selection, errors_say_what_is_wrong) {
  EXPECT_TRUE(has(error_of([] { totals({}); }), "at least one"));
  EXPECT_TRUE(has(error_of([] { totals({{{1, 2}, true}, {{1}, true}}); }), "2 and 1"));
  EXPECT_TRUE(has(error_of([] {
                    totals({{{1, 2}, true, "a"}, {{1, std::nan("")}, true, "b"}});
                  }),
                  "score 1 of signal b is not a number"));
}

TEST(Agreement, is_the_mean_share_that_has_the_same_code) {
  const std::vector<double> shares =
      agreement({{{1, 2, 3}}, {{1, 2, 4}}, {{5, 2, 4}}, {{1, 6, 4}}});
  const std::vector<double> expected = {(3 + 3 + 1) / 12., (3 + 3 + 3) / 12., (1 + 3 + 3) / 12.,
                                        (3 + 1 + 3) / 12.};
  ASSERT_EQ(shares.size(), expected.size());
  for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_DOUBLE_EQ(shares[i], expected[i]) << i;
  EXPECT_EQ(best_of(shares), 1u);
  EXPECT_EQ(agreement({{{7, 8}}}), std::vector<double>{1});
  EXPECT_TRUE(agreement({}).empty());
}

}  // namespace
}  // namespace ps::outpaint
