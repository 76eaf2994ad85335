// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libps/core/image.h"

namespace ps {

/// @brief One question of a study: which of two pictures? Nobody who answers is told which is
/// whose.
struct AbTrial {
  std::size_t pair = 0;
  /// The pair's picture of method A (or B, by `of_b`) against a broken copy of it: the answer is
  /// known, and who gives the other did not look.
  bool sentinel = false;
  bool of_b = false;
  int vote = 0;          ///< 0 or 1: each pair is asked twice, the second time with sides exchanged
  bool swapped = false;  ///< B's (or the broken) picture is on the left
};

/// @brief Plans a study as PixelSynth's (section 4.2): forced choices in random order, all first
/// votes before all second ones, so that nobody remembers; sentinels anywhere. Who always takes one
/// side agrees with themselves on no pair. A function of the arguments alone.
/// @param pairs      each is asked twice
/// @param sentinels  each is asked once, of pairs by turns
std::vector<AbTrial> plan_ab_study(std::size_t pairs, std::size_t sentinels, std::uint64_t seed);

/// @return 0 to count - 1 in random order, by the seed
std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed, std::uint32_t purpose);

/// @brief A copy that nobody takes for the better one: blurred over a twentieth of its short side,
/// then noisy (sigma 0.15). In [0,1]; by the seed.
Image broken_copy(const Image& image, std::uint64_t seed);

}  // namespace ps
