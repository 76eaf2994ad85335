// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/geometry/point.h"
#include "libps/scene/stress_axes.h"
#include "libps/scene/stress_suite.h"
#include "tests/scene/tiny_suite.h"

namespace ps::stress {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

Axis plain_axis() {
  Axis axis;
  axis.name = "plain";
  axis.values = {0, 1, 2, 4};
  axis.score = "PSNR";
  axis.score_unit = "dB";
  axis.limit = 20;
  axis.methods = {"ours"};
  return axis;
}

Outcome scored(double score) {
  Outcome outcome;
  outcome.score = [score] { return score; };
  outcome.picture = Image(2, 2, cv::Vec3f(.5f, .5f, .5f));
  return outcome;
}

TEST(Stress, a_breaking_point_lies_between_the_steps_around_the_limit) {
  Axis axis = plain_axis();
  EXPECT_EQ(breaking_point(axis, {30, 26, 22, 14}), 2.5);
  EXPECT_EQ(breaking_point(axis, {30, 20, 20, 20}), kInfinite);
  EXPECT_EQ(breaking_point(axis, {19, 30, 30, 30}), 0);
  EXPECT_EQ(breaking_point(axis, {30, 10, 30, 30}), .5) << "the first crossing counts";
  EXPECT_EQ(breaking_point(axis, {30, 28, kNaN, 10}), 2) << "no score breaks at its own value";
  axis.higher_is_better = false;
  EXPECT_EQ(breaking_point(axis, {0, 10, 30, 40}), 1.5);
  EXPECT_EQ(criterion_of(axis), "PSNR is over 20 dB");
}

TEST(Stress, jumps_are_falls_that_neither_the_rest_nor_another_method_has) {
  Axis axis = plain_axis();
  axis.values = {0, 1, 2, 3, 4, 5};
  const std::vector<double> cliff = {30, 29, 28, 15, 14, 13};
  EXPECT_EQ(jumps(axis, cliff, {}), std::vector<std::size_t>{3});
  EXPECT_TRUE(jumps(axis, cliff, {{28, 28, 27, 19, 19, 18}}).empty()) << "the input jumps";
  EXPECT_TRUE(jumps(axis, {30, 27, 24, 21, 18, 15}, {}).empty());
  EXPECT_TRUE(jumps(axis, {13, 14, 15, 28, 29, 30}, {}).empty()) << "it gets better";
  EXPECT_TRUE(jumps(axis, {30, 29, 28, kNaN, 14, 13}, {}).empty());
}

TEST(Stress, a_run_keeps_scores_refusals_and_pictures) {
  Axis axis = plain_axis();
  axis.run = [](const std::string&, double value) {
    if (value == 4) throw Error("depth", "there is none");
    return scored(30 - 6 * value);
  };
  int steps = 0;
  const AxisResult result = run_axis(axis, 1, [&] { ++steps; });
  EXPECT_EQ(steps, 4);
  ASSERT_EQ(result.curves.size(), 1u);
  const Curve& curve = result.curves[0];
  EXPECT_DOUBLE_EQ(curve.breaks, 1 + 4. / 6);
  EXPECT_EQ(curve.first_broken(axis), 2u);
  EXPECT_TRUE(std::isnan(curve.steps[3].score));
  EXPECT_EQ(curve.steps[3].refused, "depth: there is none");
  EXPECT_FALSE(curve.steps[1].picture.empty());
  EXPECT_TRUE(result.violations.empty()) << result.violations[0].what;
}

/// What run_axis() says of a run that goes wrong at one value.
std::string violation_of(const std::function<void(Outcome*)>& spoil) {
  Axis axis = plain_axis();
  axis.run = [&](const std::string&, double value) {
    Outcome outcome = scored(30);
    if (value == 2) spoil(&outcome);
    return outcome;
  };
  const AxisResult result = run_axis(axis, 2);
  if (result.violations.size() != 1) return std::to_string(result.violations.size());
  EXPECT_EQ(result.violations[0].value, 2);
  EXPECT_EQ(result.violations[0].axis, "plain");
  return result.violations[0].what;
}

TEST(Stress, what_must_not_be_is_found) {
  EXPECT_EQ(violation_of([](Outcome*) {}), "0");
  EXPECT_EQ(violation_of([](Outcome*) { throw std::runtime_error("boom"); }),
            "an exception that is no ps::Error: boom");
  EXPECT_EQ(violation_of([](Outcome*) {
              if (threads() == 2) throw std::runtime_error("boom");
            }),
            "on two threads, an exception that is no ps::Error: boom");
  EXPECT_EQ(violation_of([](Outcome* o) {
              o->score = []() -> double { throw std::runtime_error("boom"); };
            }),
            "an exception that is no ps::Error: boom");
  EXPECT_EQ(violation_of([](Outcome* o) { o->picture(0, 1)[2] = NAN; }), "not finite");
  EXPECT_EQ(violation_of([](Outcome* o) { o->finite = false; }), "not finite");
  EXPECT_EQ(violation_of([](Outcome* o) { o->overwritten = "half of it"; }), "half of it");
  EXPECT_EQ(violation_of([](Outcome* o) { o->digest = static_cast<std::uint64_t>(threads()); }),
            "other bytes on two threads than on one");
  EXPECT_EQ(
      violation_of([](Outcome* o) { o->picture(1, 1)[0] = static_cast<float>(threads()) / 2; }),
      "other bytes on two threads than on one");
}

TEST(Stress, a_score_may_be_refused) {
  Axis axis = plain_axis();
  axis.run = [](const std::string&, double value) {
    Outcome outcome = scored(30);
    if (value == 2) outcome.score = []() -> double { throw Error("cloud", "is empty"); };
    return outcome;
  };
  const AxisResult result = run_axis(axis, 2);
  EXPECT_TRUE(result.violations.empty());
  EXPECT_EQ(result.curves[0].steps[2].refused, "cloud: is empty");
  EXPECT_TRUE(std::isnan(result.curves[0].steps[2].score));
  EXPECT_EQ(result.curves[0].breaks, 2);
}

TEST(Stress, one_thread_runs_each_step_once) {
  Axis axis = plain_axis();
  std::vector<int> runs;
  axis.run = [&](const std::string&, double) {
    runs.push_back(threads());
    return scored(30);
  };
  run_axis(axis, 1);
  EXPECT_EQ(runs, std::vector<int>(4, 1));
  runs.clear();
  run_axis(axis, 3);
  EXPECT_EQ(runs, (std::vector<int>{2, 1, 2, 1, 2, 1, 2, 1}));
  EXPECT_EQ(threads(), 3);
  set_threads(0);
}

TEST(Stress, an_axis_of_one_value_or_no_method_is_refused) {
  Axis axis = plain_axis();
  axis.values = {0};
  EXPECT_THROW(run_axis(axis, 1), Error);
  axis = plain_axis();
  axis.methods.clear();
  EXPECT_THROW(run_axis(axis, 1), Error);
}

TEST(Stress, clouds_have_digests_and_may_not_be_finite) {
  Cloud cloud;
  cloud.resize(3);
  const std::uint64_t before = digest_of(cloud);
  cloud[1].g = 1;
  EXPECT_NE(digest_of(cloud), before);
  EXPECT_TRUE(finite(cloud));
  cloud[2].y = NAN;
  EXPECT_FALSE(finite(cloud));
}

TEST(Stress, pictures_have_digests_whatever_their_colours) {
  const Image picture(2, 2, cv::Vec3f(.5f, .5f, .5f));
  std::set<std::uint64_t> digests = {digest_of(picture)};
  for (const float x : {std::nextafter(.5f, 1.f), 1e-9f, 2e-9f, -1.f, -2.f, NAN, INFINITY}) {
    Image other = picture.clone();
    other(1, 0)[1] = x;
    EXPECT_TRUE(digests.insert(digest_of(other)).second) << x;
  }
  EXPECT_EQ(digest_of(picture), digest_of(picture.clone()));
}

TEST(StressAxes, have_unlike_names_rising_values_and_ours_first) {
  SuiteOptions dense;
  dense.dense = true;
  std::set<std::string> names;
  for (const SuiteOptions& options : {SuiteOptions(), dense}) {
    names.clear();
    for (const auto& axes : {fusion_axes(options), cloud_axes(options), photo_axes(options, {})}) {
      for (const Axis& axis : axes) {
        EXPECT_TRUE(names.insert(axis.name).second) << axis.name;
        EXPECT_TRUE(std::is_sorted(axis.values.begin(), axis.values.end())) << axis.name;
        EXPECT_EQ(axis.methods[0], "ours");
        EXPECT_GE(axis.methods.size(), 3u);
      }
    }
  }
  EXPECT_GE(names.size(), 15u);
}

TEST(StressAxes, score_the_undisturbed_scene_by_every_method) {
  std::vector<Axis> axes = fusion_axes(tiny_suite());
  for (Axis& axis : cloud_axes(tiny_suite())) axes.push_back(std::move(axis));
  for (const Axis& axis : axes) {
    const double first = axis.run("ours", axis.values[0]).score();
    EXPECT_TRUE(std::isfinite(first) && first > 0) << axis.name;
  }
  for (const std::string& method : axes[0].methods) {
    EXPECT_GT(axes[0].run(method, 0).score(), 60) << method;
  }
  EXPECT_THROW(axes[0].run("best", 0), Error);
}

TEST(StressAxes, a_disturbance_leaves_the_undisturbed_as_it_was) {
  for (const Axis& axis : fusion_axes(tiny_suite())) {
    const std::uint64_t before = axis.run("all points", 0).digest;
    const std::uint64_t disturbed = axis.run("all points", axis.values.back()).digest;
    EXPECT_NE(disturbed, before) << axis.name;
    EXPECT_EQ(axis.run("all points", 0).digest, before) << axis.name;
  }
}

TEST(StressAxes, splats_are_as_wide_as_they_are_asked_for) {
  for (const Axis& axis : cloud_axes(tiny_suite())) {
    if (axis.name != "splat-wide") continue;
    for (const std::string& method : axis.methods) {
      EXPECT_NE(digest_of(axis.run(method, 1).picture), digest_of(axis.run(method, 8).picture))
          << method;
    }
  }
}

TEST(StressAxes, what_goes_wrong_follows_the_seed) {
  SuiteOptions other = tiny_suite();
  other.seed = 1;
  EXPECT_NE(draw_seed(other, 0), draw_seed(tiny_suite(), 0));
  EXPECT_NE(draw_seed(other, 1), draw_seed(other, 0));
}

TEST(StressAxes, photos_need_no_networks_where_methods_need_none) {
  for (const Axis& axis : photo_axes(tiny_suite(), {})) {
    if (axis.name != "rotation" && axis.name != "photo-tiny") continue;
    const Outcome outcome = axis.run("nearest", axis.values[1]);
    EXPECT_TRUE(outcome.finite);
    EXPECT_GT(outcome.score(), 8) << axis.name;
    EXPECT_EQ(axis.truth(axis.values[1]).size(), outcome.picture.size());
  }
}

}  // namespace
}  // namespace ps::stress
