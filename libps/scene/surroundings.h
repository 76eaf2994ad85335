// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: how far around a point its surface shows nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "libps/scene/sample_grid.h"

namespace ps {

/// @brief For each step of distance from a sample, the greatest difference between the colours that
/// splats show at it and at any sample up to there: 0 to 254, or kApart where the surface bends.
/// All kApart for a sample where a surface ends, or that is on none; differences to it do not
/// count.
struct Surroundings {
  static constexpr int kSteps = 8;
  static constexpr std::uint8_t kApart = 255;
  std::array<std::uint8_t, kSteps> difference = {};
  float clear = std::numeric_limits<float>::infinity();  ///< metres to the nearest that is kApart

  /// @return how many steps around it differ by no more than the tolerance
  int alike(int tolerance) const {
    int steps = 0;
    while (steps < kSteps && difference[steps] <= tolerance) ++steps;
    return steps;
  }
};

/// What to look at; all in pixels of each sample.
struct LookOptions {
  float radius = 4;   ///< of the widest splats: what planes are laid through; at most the grid's
  float finest = 1;   ///< of the narrowest splats: what colours are averaged over
  float reach = 3;    ///< how far to look; at most the radius
  float flat = 0.5f;  ///< how far a surface may be off its plane
};

/// @brief Looks around every sample.
/// @param meter  if given, told of samples, each twice, as parts of its stage
std::vector<Surroundings> look_around(const std::vector<Sample>& samples, const SampleGrid& grid,
                                      const LookOptions& options, Meter* meter = nullptr);

}  // namespace ps
