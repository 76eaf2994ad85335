// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: a cloud that can be thinned again and again, as a search does.
#pragma once

#include <vector>

#include "libps/scene/surroundings.h"

namespace ps {

/// @brief Looks at samples once, then thins them to any tolerance.
class Thinner {
 public:
  /// A tolerance at which all colours are alike; those below are whole steps of 8-bit colours.
  static constexpr double kAllColors = Surroundings::kApart - 1;

  /// @param samples  as seen_samples() gives them
  /// @param meter    if given, told of two stages, to 0.9 of all, and of one for each thinning;
  /// must outlive this
  Thinner(const std::vector<Sample>& samples, const BudgetOptions& options, Meter* meter = nullptr);

  /// @param tolerance  0 to kAllColors; its fraction is the share of the samples, spread evenly,
  /// that are given one more
  std::vector<Sample> at(double tolerance) const;

  /// @brief Thins by as little as leaves at most `most`, if that can be; writes to the report what
  /// tolerance it took, or that edges had to be merged across, and within how many pixels.
  std::vector<Sample> down_to(std::size_t most, BudgetReport* report) const;

 private:
  std::vector<Sample> merged_across(const std::vector<Sample>& samples, double pixels) const;

  Meter* const meter_;
  const float pixels_;   ///< BudgetOptions::pixels
  const float radius_;   ///< pixels, of splats
  const float spacing_;  ///< pixels
  std::vector<Sample> samples_;
  const SampleGrid grid_;
  const std::vector<Surroundings> surroundings_;
};

}  // namespace ps
