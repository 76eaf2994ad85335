// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/knobs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "libps/core/parallel.h"
#include "libps/scene/knob_samples.h"
#include "tests/support/random_weights.h"

namespace ps {
namespace {

const KnobSample& tiny_room() {
  static const KnobSample sample = room_sample(17, 64);
  return sample;
}

/// Small networks by chance.
struct Networks {
  models::Autoencoder autoencoder{models::random_autoencoder(16, 8, 8, 32)};
  models::PixelCnn pixel_cnn{models::random_pixel_cnn(8, 32)};
  models::Refiner refiner{models::random_refiner(8)};
  models::DepthNet depth{models::random_depth_net(4)};

  OutpaintKnobOptions options() const {
    OutpaintKnobOptions options;
    const outpaint::Scorer mean = {"discriminator", true, [](const nn::TensorView& image, auto&) {
                                     return static_cast<double>(*image.pixel(0));
                                   }};
    const outpaint::Scorer last = {
        "entropy", false, [](const nn::TensorView& image, auto&) {
          return static_cast<double>(*image.pixel(image.shape.pixels() - 1));
        }};
    options.networks = {{&autoencoder, &pixel_cnn, &refiner, {mean, last}}, &depth, {}};
    options.selection_samples = 2;
    return options;
  }
};

std::vector<Knob> all_knobs(const Networks& networks) {
  return {samples_knob(networks.options()),
          guidance_knob(networks.options()),
          selection_knob(networks.options()),
          radius_knob(),
          points_per_pixel_knob(),
          budget_knob(),
          image_size_knob(),
          arithmetic_knob(models::random_refiner(8)),
          width_knob({{"f4", &networks.depth, {}, true}, {"f4 again", &networks.depth, {}}})};
}

TEST(Knobs, have_one_default_and_settings_of_different_names) {
  const Networks networks;
  for (const Knob& knob : all_knobs(networks)) {
    int defaults = 0;
    std::set<std::string> names;
    for (const KnobSetting& setting : knob.settings) {
      defaults += setting.is_default;
      names.insert(setting.name);
    }
    EXPECT_EQ(defaults, 1) << knob.name;
    EXPECT_EQ(names.size(), knob.settings.size()) << knob.name;
    EXPECT_FALSE(knob.timed.empty()) << knob.name;
    ASSERT_FALSE(knob.scores.empty()) << knob.name;
    EXPECT_TRUE(knob.scores.front().higher_is_better) << knob.name;
  }
}

/// Runs all settings of a knob once.
std::vector<KnobTrial> trials_of(const Knob& knob, const KnobSample& sample) {
  const KnobBench bench = knob.prepare(sample);
  EXPECT_FALSE(bench.truth.empty());
  std::vector<KnobTrial> trials;
  for (std::size_t s = 0; s < knob.settings.size(); ++s) {
    trials.push_back(bench.run(s));
    EXPECT_GT(trials.back().seconds, 0) << knob.name;
    EXPECT_EQ(trials.back().scores.size(), knob.scores.size()) << knob.name;
    EXPECT_TRUE(std::isfinite(trials.back().scores.front())) << knob.name << " " << s;
    EXPECT_EQ(trials.back().picture.size(), bench.truth.size()) << knob.name;
  }
  return trials;
}

double accuracy(const Knob& knob, const std::vector<KnobTrial>& trials, const char* setting) {
  for (std::size_t s = 0; s < trials.size(); ++s) {
    if (knob.settings[s].name == setting) return trials[s].scores.front();
  }
  ADD_FAILURE() << knob.name << " has no setting " << setting;
  return 0;
}

TEST(Knobs, of_splats_give_finite_numbers_that_say_what_they_should) {
  const Knob radius = radius_knob(), points = points_per_pixel_knob(), budget = budget_knob(),
             size = image_size_knob();
  const auto of_radius = trials_of(radius, tiny_room());
  // Half a pixel leaves holes, eight blur.
  EXPECT_GT(accuracy(radius, of_radius, "1"), accuracy(radius, of_radius, "0.5"));
  EXPECT_GT(accuracy(radius, of_radius, "2"), accuracy(radius, of_radius, "8"));
  const auto of_points = trials_of(points, tiny_room());
  EXPECT_GT(accuracy(points, of_points, "32"), accuracy(points, of_points, "1"));
  const auto of_budget = trials_of(budget, tiny_room());
  for (std::size_t s = 1; s < 7; ++s) EXPECT_GT(of_budget[s].scores[1], of_budget[s - 1].scores[1]);
  EXPECT_NE(accuracy(budget, of_budget, "2 %"), accuracy(budget, of_budget, "100 %"));
  EXPECT_EQ(accuracy(budget, of_budget, "100 %"), accuracy(radius, of_radius, "1 to 4"));
  const auto of_size = trials_of(size, tiny_room());
  EXPECT_GT(accuracy(size, of_size, "100 %"), accuracy(size, of_size, "25 %"));
  EXPECT_EQ(accuracy(size, of_size, "100 %"), accuracy(radius, of_radius, "1 to 4"));
}

TEST(Knobs, of_arithmetic_are_near_the_transposed_network_but_bf16_is_not) {
  const Knob knob = arithmetic_knob(models::random_refiner(16));
  const auto trials = trials_of(knob, tiny_room());
  EXPECT_GT(accuracy(knob, trials, "f32 direct"), 100);
  EXPECT_LT(accuracy(knob, trials, "f32 direct"), 170);
  EXPECT_GT(accuracy(knob, trials, "f32 Winograd"), 90);
  EXPECT_LT(accuracy(knob, trials, "bf16 weights"), 80);
}

TEST(Knobs, of_outpainting_score_what_the_input_does_not_see) {
  const Networks networks;
  OutpaintKnobOptions options = networks.options();
  options.perceptual = [](const Image& a, const Image& b) { return cv::norm(a, b); };
  const Knob knob = selection_knob(options);
  const auto trials = trials_of(knob, tiny_room());
  for (const KnobTrial& trial : trials) {
    EXPECT_LT(trial.scores[0], trial.scores[1]);  // chance paints worse than the cloud
    EXPECT_GT(trial.scores[2], 0);
  }
}

TEST(Knobs, guidance_changes_what_is_outpainted) {
  const Networks networks;
  const auto trials = trials_of(guidance_knob(networks.options()), tiny_room());
  for (std::size_t s = 1; s < trials.size(); ++s) {
    EXPECT_GT(cv::norm(trials[s].picture, trials[0].picture, cv::NORM_INF), 1e-3) << s;
  }
}

TEST(Knobs, of_width_score_the_depth_of_the_input) {
  const Networks networks;
  const Knob knob = width_knob({{"a", &networks.depth, {}, true}, {"b", &networks.depth, {}}});
  const auto trials = trials_of(knob, tiny_room());
  EXPECT_EQ(trials[0].scores, trials[1].scores);
  EXPECT_GT(trials[0].scores[1], 0);
  EXPECT_LE(trials[0].scores[0], 1);
}

TEST(KnobSamples, of_rooms_are_pairs_and_do_not_depend_on_threads) {
  const KnobSample& a = tiny_room();
  set_threads(3);
  const KnobSample b = room_sample(17, 64);
  set_threads(0);
  EXPECT_EQ(cv::norm(a.target.color, b.target.color), 0);
  EXPECT_EQ(a.others.size(), 4u);
  const auto pairs =
      choose_pairs({a.input.world_from_cam, a.target.world_from_cam}, {}, PairRange(), 2);
  EXPECT_EQ(pairs.size(), 2u);  // in range both ways
  EXPECT_NE(cv::norm(a.input.color, room_sample(18, 64).input.color), 0);
}

TEST(KnobSamples, of_frames_take_the_nearest_others_of_the_world_but_for_neighbours) {
  std::vector<Pose> poses;
  std::vector<int> worlds;
  for (int i = 0; i < 40; ++i) {  // two walks that turn by 4 degrees a step
    Pose pose = Pose::Identity();
    pose.rotate(Eigen::AngleAxisd(i % 20 * 4 * M_PI / 180, Eigen::Vector3d::UnitY()));
    poses.push_back(pose);
    worlds.push_back(i / 20);
  }
  const auto pose_of = [&](std::size_t i) { return poses[i]; };
  const auto sets = choose_frame_sets(worlds, pose_of, 6, 3, 1);
  ASSERT_EQ(sets.size(), 6u);
  for (const FrameSet& set : sets) {
    EXPECT_EQ(set.others.size(), 4u);
    for (const std::size_t other : set.others) {
      const auto steps = std::abs(static_cast<int>(other) - static_cast<int>(set.pair.target));
      EXPECT_EQ(worlds[other], worlds[set.pair.target]);
      EXPECT_NE(other, set.pair.source);
      EXPECT_GE(steps, 3);
      EXPECT_LE(steps, 8);
    }
  }
}

}  // namespace
}  // namespace ps
