// SPDX-License-Identifier: BSD-3-Clause
// What the outpainter's progress function is told, and what its answer does.
#include "libps/core/parallel.h"
#include "tests/io/support.h"
#include "tests/outpaint/outpainter_fixture.h"

namespace ps::outpaint {
namespace {

struct Way {
  const char* name;
  void (*set)(OutpaintOptions& options, cv::Mat1b& background);
};
void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

const Way kWays[] = {
    {"all_refined", [](OutpaintOptions&, cv::Mat1b&) {}},
    {"the_best_unrefined_few", [](OutpaintOptions& o, cv::Mat1b&) { o.refine_best = 2; }},
    {"the_likeliest_few",
     [](OutpaintOptions& o, cv::Mat1b&) {
       o.refine_best = 2;
       o.screen = OutpaintOptions::Screen::likelihood;
     }},
    {"until_settled",
     [](OutpaintOptions& o, cv::Mat1b&) {
       o.until_settled = true;
       o.samples = 10;
     }},
    {"region_off", [](OutpaintOptions& o, cv::Mat1b&) { o.region = false; }},
    {"no_cell_missing",
     [](OutpaintOptions&, cv::Mat1b& b) {
       b = 0;
       b(cv::Rect(0, 0, 5, kHeight)) = 1;
     }},
    {"nothing_missing", [](OutpaintOptions&, cv::Mat1b& b) { b = 0; }},
};

class OutpainterProgress : public OutpainterOfRandomWeights,
                           public testing::WithParamInterface<Way> {
 protected:
  OutpainterProgress() {
    options_.samples = 3;
    GetParam().set(options_, background_);
  }
  Outpainter painter() const {
    return outpainter({discriminator_scorer(discriminator_), entropy_scorer(classifier_)});
  }
  /// Every share that a whole run tells.
  std::vector<double> told(Outpainter& painter) {
    std::vector<double> shares;
    options_.progress = [&](double done) {  // one call at a time
      shares.push_back(done);
      return true;
    };
    painter.run(projection_, background_, options_);
    return shares;
  }

  OutpaintOptions options_;
};

TEST_P(OutpainterProgress, rises_from_0_to_1_in_every_stage) {
  Outpainter outpainter = painter();
  const std::vector<double> shares = told(outpainter);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GE(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  const Outpainted result = outpainter.run(projection_, background_, options_);
  if (result.report.drawn == 0) return;
  // Encoded, each level, and of each that was refined: decoded, refined, two scores.
  EXPECT_GE(shares.size(), 1 + result.report.levels + 4 * result.refined.size());
  // No step but the last, to the end, is most of the whole.
  if (options_.until_settled) return;
  for (std::size_t i = 1; i + 1 < shares.size(); ++i) EXPECT_LT(shares[i] - shares[i - 1], 0.6);
}

TEST_P(OutpainterProgress, stops_with_nothing_wherever_it_is_told_to) {
  Outpainter outpainter = painter();
  const std::size_t calls = told(outpainter).size();
  options_.progress = nullptr;
  const Outpainted whole = outpainter.run(projection_, background_, options_);
  for (std::size_t last = 1; last <= calls; last += 1 + calls / 12) {
    std::size_t called = 0;
    options_.progress = [&](double) { return ++called < last; };
    const Outpainted result = outpainter.run(projection_, background_, options_);
    EXPECT_EQ(called, last) << "called again after it said stop";
    EXPECT_EQ(result.image.shape().pixels(), 0u) << last;
    EXPECT_EQ(result.best, -1);
    EXPECT_TRUE(result.codes.empty());
    EXPECT_TRUE(result.totals.empty());
    EXPECT_TRUE(result.refined.empty());
    EXPECT_TRUE(result.scores.empty());
  }
  options_.progress = nullptr;
  const Outpainted again = outpainter.run(projection_, background_, options_);
  EXPECT_EQ(worst_difference(again.image, whole.image), 0);
  EXPECT_EQ(again.totals, whole.totals);
}

TEST_P(OutpainterProgress, what_it_throws_comes_out) {
  Outpainter outpainter = painter();
  const std::size_t calls = told(outpainter).size();
  for (const std::size_t last : {std::size_t{1}, (calls + 1) / 2, calls}) {
    std::size_t called = 0;
    options_.progress = [&](double) -> bool {
      if (++called == last) throw Error("progress", "interrupted");
      return true;
    };
    EXPECT_TRUE(
        has(error_of([&] { outpainter.run(projection_, background_, options_); }), "interrupted"));
    EXPECT_EQ(called, last);
  }
}

INSTANTIATE_TEST_SUITE_P(ways, OutpainterProgress, testing::ValuesIn(kWays),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace ps::outpaint
