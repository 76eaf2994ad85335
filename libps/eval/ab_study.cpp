// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/ab_study.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "libps/core/parallel.h"
#include "libps/core/random.h"

namespace ps {
namespace {

enum Purpose : std::uint32_t { kSide = 0x6162, kWhich, kPlace, kOrder, kNoise };  ///< of numbers

bool coin(std::uint64_t seed, std::size_t i, Purpose purpose) {
  return random_bits(seed, {static_cast<std::uint32_t>(i), purpose, 0, 0})[0] % 2 == 1;
}

}  // namespace

std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed, std::uint32_t purpose) {
  std::vector<std::pair<double, std::size_t>> drawn(count);
  for (std::size_t i = 0; i < count; ++i) {
    drawn[i] = {random_unit(seed, {static_cast<std::uint32_t>(i), kOrder, purpose, 0}), i};
  }
  std::sort(drawn.begin(), drawn.end());
  std::vector<std::size_t> order(count);
  std::transform(drawn.begin(), drawn.end(), order.begin(), [](const auto& d) { return d.second; });
  return order;
}

std::vector<AbTrial> plan_ab_study(std::size_t pairs, std::size_t sentinels, std::uint64_t seed) {
  std::vector<AbTrial> trials;
  for (const int vote : {0, 1}) {
    for (const std::size_t pair : shuffled(pairs, seed, static_cast<std::uint32_t>(vote))) {
      trials.push_back({pair, false, false, vote, coin(seed, pair, kSide) != (vote == 1)});
    }
  }
  const std::vector<std::size_t> of = shuffled(pairs, seed, 2);
  for (std::size_t i = 0; i < sentinels && pairs > 0; ++i) {
    const AbTrial trial = {of[i % pairs], true, coin(seed, i, kWhich), 0,
                           coin(seed, pairs + i, kSide)};
    const double place = random_unit(seed, {static_cast<std::uint32_t>(i), kPlace, 0, 0});
    const auto at = static_cast<std::ptrdiff_t>(place * static_cast<double>(trials.size() + 1));
    trials.insert(trials.begin() + at, trial);
  }
  return trials;
}

Image broken_copy(const Image& image, std::uint64_t seed) {
  Image broken;
  const double sigma = std::max(1.0, std::min(image.cols, image.rows) / 20.0);
  cv::GaussianBlur(image, broken, {0, 0}, sigma);
  parallel_for(static_cast<std::size_t>(broken.rows), [&](std::size_t y) {
    for (int x = 0; x < broken.cols; ++x) {
      const auto row = static_cast<std::uint32_t>(y), column = static_cast<std::uint32_t>(x);
      const auto first = random_normal(seed, {row, column, kNoise, 0});
      const auto second = random_normal(seed, {row, column, kNoise, 1});
      cv::Vec3f& color = broken(static_cast<int>(y), x);
      const double noise[3] = {first[0], first[1], second[0]};
      for (int c = 0; c < 3; ++c) {
        color[c] = std::clamp(color[c] + 0.15f * static_cast<float>(noise[c]), 0.f, 1.f);
      }
    }
  });
  return broken;
}

}  // namespace ps
