// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/camera_effects.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libps/core/error.h"

namespace ps::rooms {
namespace {

Shot gradient(int width, int height) {
  Shot s{width, height, {}, {}};
  for (int i = 0; i < width * height; ++i) {
    for (int c = 0; c < 3; ++c) {
      s.color.push_back(0.1f + 0.7f * static_cast<float>((i % width + c * 7) % 40) / 40);
    }
    s.depth.push_back(static_cast<float>(i));
  }
  return s;
}

EffectOptions none() { return {0, 0, 0, 0, 0, 0, 0, 0, 0}; }

float change(const Shot& a, const Shot& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.color.size(); ++i) sum += std::abs(a.color[i] - b.color[i]);
  return static_cast<float>(sum / static_cast<double>(a.color.size()));
}

TEST(Degrade, leaves_depth_alone_and_colours_within_range) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Shot before = gradient(37, 21);
    Shot after = before;
    degrade(after, seed);
    EXPECT_EQ(after.depth, before.depth);
    EXPECT_GT(change(before, after), 1e-3f);
    for (const float c : after.color) EXPECT_TRUE(c >= 0 && c <= 1);
  }
}

TEST(Degrade, is_a_function_of_its_seed) {
  Shot a = gradient(32, 24), b = a, c = a;
  degrade(a, 5);
  degrade(b, 5);
  degrade(c, 6);
  EXPECT_EQ(a.color, b.color);
  EXPECT_NE(a.color, c.color);
}

TEST(Degrade, does_nothing_when_all_is_off) {
  const Shot before = gradient(32, 24);
  Shot after = before;
  degrade(after, 3, none());
  EXPECT_LT(change(before, after), 1e-3f);
}

TEST(Degrade, does_each_effect_on_its_own) {
  float EffectOptions::*const effects[] = {
      &EffectOptions::exposure,   &EffectOptions::white_balance, &EffectOptions::vignetting,
      &EffectOptions::contrast,   &EffectOptions::saturation,    &EffectOptions::blur,
      &EffectOptions::sharpening, &EffectOptions::noise,         &EffectOptions::jpeg};
  for (const auto effect : effects) {
    EffectOptions o = none();
    o.*effect = EffectOptions{}.*effect;
    float most = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Shot before = gradient(32, 24);
      Shot after = before;
      degrade(after, seed, o);
      most = std::max(most, change(before, after));
    }
    EXPECT_GT(most, 2e-3f);
  }
}

TEST(Degrade, refuses_a_shot_whose_sizes_do_not_agree) {
  Shot s = gradient(8, 8);
  s.color.pop_back();
  EXPECT_THROW(degrade(s, 1), Error);
}

}  // namespace
}  // namespace ps::rooms
