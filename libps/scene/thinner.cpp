// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/thinner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libps/scene/closed_splat.h"
#include "libps/scene/merge.h"

namespace ps {
namespace {

constexpr float kWidestJudged = 8;       ///< pixels; wider splats are judged as if so wide
constexpr float kFinestCell = 1.f / 16;  ///< pixels
constexpr std::size_t kCrowd = 2;        ///< samples in a cell that are not too many
constexpr int kRounds = 16;              ///< of a search, at most
constexpr double kNearEnough = 0.97;     ///< of the points asked for, to end a search
constexpr double kUncrowded = 0.5, kLooked = 0.9;  ///< shares of a thinning that are done then
constexpr double kOfRest = 0.4;                    ///< what a thinning takes of what is left
constexpr double kMostPixels = 4096;               ///< within which a search merges across edges

/// Merges what is within so many pixels where it is crowded, so that afterwards nobody has very
/// many neighbours.
std::vector<Sample> without_crowds(const std::vector<Sample>& samples, float pixels, Meter* meter) {
  if (meter) meter->stage(kUncrowded, 3 * samples.size());
  const SampleGrid grid(samples, std::max(pixels, kFinestCell), meter);
  std::vector<float> reach(samples.size(), 0);
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    const SampleGrid::Span own = grid.own(cell);
    if (own.size() <= kCrowd) continue;
    for (const std::uint32_t i : own) reach[i] = pixels;
  }
  return merged(samples, grid, reach, meter);
}

/// Begins the stage of the grid and of looking around.
const std::vector<Sample>& begin_look(const std::vector<Sample>& samples, Meter* meter) {
  if (meter) meter->stage(kLooked, 3 * samples.size());
  return samples;
}

/// @brief Searches for the largest result that is at most `most`.
/// @param trial  (x) -> samples, fewer for greater x
/// @param low    where they are too many
/// @param high   where they are not
/// @param found  receives x
template <typename Trial>
std::vector<Sample> largest_within(std::size_t most, double low, double high, const Trial& trial,
                                   double* found) {
  std::vector<Sample> best = trial(high);
  *found = high;
  for (int round = 0; round < kRounds; ++round) {
    if (static_cast<double>(best.size()) >= kNearEnough * static_cast<double>(most)) break;
    const double middle = (low + high) / 2;
    std::vector<Sample> result = trial(middle);
    (result.size() > most ? low : high) = middle;
    if (result.size() > most || result.size() < best.size()) continue;
    best = std::move(result);
    *found = middle;
  }
  return best;
}

}  // namespace

Thinner::Thinner(const std::vector<Sample>& samples, const BudgetOptions& options, Meter* meter)
    : meter_(meter),
      pixels_(static_cast<float>(options.pixels)),
      radius_(std::min(options.radius, kWidestJudged)),
      spacing_(static_cast<float>(options.spacing) * radius_),
      samples_(without_crowds(samples, pixels_, meter)),
      grid_(begin_look(samples_, meter), std::max(radius_, pixels_), meter),
      surroundings_(look_around(
          samples_, grid_, {radius_, std::min(radius_, kFinestSplat), spacing_, pixels_}, meter)) {
  for (std::size_t i = 0; i < samples_.size(); ++i) samples_[i].clear = surroundings_[i].clear;
}

/// Merges what is within so many pixels, edges or not.
std::vector<Sample> Thinner::merged_across(const std::vector<Sample>& samples,
                                           double pixels) const {
  const auto reach = static_cast<float>(pixels);
  if (meter_) meter_->stage_of_rest(kOfRest, 3 * samples.size());
  return merged(samples, SampleGrid(samples, reach, meter_),
                std::vector<float>(samples.size(), reach), meter_);
}

std::vector<Sample> Thinner::at(double tolerance) const {
  if (meter_) meter_->stage_of_rest(kOfRest, 2 * samples_.size());
  std::vector<float> reach(samples_.size());
  for (std::size_t i = 0; i < reach.size(); ++i) {
    // Multiples of the golden ratio: neighbours in number, and so in space, get unlike fractions.
    const double golden = static_cast<double>(i) * 0.6180339887498949;
    const auto given = static_cast<int>(tolerance + golden - std::floor(golden));
    const auto steps = static_cast<float>(surroundings_[i].alike(given));
    reach[i] = std::max(pixels_, spacing_ * steps / Surroundings::kSteps);
  }
  return merged(samples_, grid_, reach, meter_);
}

std::vector<Sample> Thinner::down_to(std::size_t most, BudgetReport* report) const {
  report->pixels = pixels_;
  report->tolerance = 0;
  std::vector<Sample> samples = at(0);
  if (samples.size() <= most) return samples;
  samples = at(kAllColors);
  report->tolerance = kAllColors;
  if (samples.size() <= most) {
    const auto trial = [&](double tolerance) { return at(tolerance); };
    samples = largest_within(most, 0, kAllColors, trial, &report->tolerance);
    report->tolerance /= Surroundings::kApart;
    return samples;
  }
  report->tolerance = 1;
  const auto across = [&](double pixels) { return merged_across(samples, pixels); };
  double high = 1;
  while (high < kMostPixels && across(high).size() > most) high *= 2;
  return largest_within(most, high / 2, high, across, &report->pixels);
}

}  // namespace ps
