// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/merge.h"

#include <algorithm>
#include <cstdint>

namespace ps {
namespace {

constexpr std::uint32_t kLeft = UINT32_MAX;

/// A sample that may take others, and its cell.
struct Turn {
  float reach;
  std::uint32_t cell;
  std::uint32_t sample;
};

std::vector<Turn> turns_of(const SampleGrid::Span& cells, const SampleGrid& grid,
                           const std::vector<float>& reach) {
  std::vector<Turn> turns;
  for (const std::uint32_t cell : cells) {
    for (const std::uint32_t i : grid.own(cell)) turns.push_back({reach[i], cell, i});
  }
  // What shows detail first, so that no neighbour takes it. Cells stay together.
  std::stable_sort(turns.begin(), turns.end(),
                   [](const Turn& a, const Turn& b) { return a.reach < b.reach; });
  return turns;
}

/// Finds for each sample the number of the one that speaks for it.
class Speakers {
 public:
  Speakers(const std::vector<Sample>& samples, const SampleGrid& grid,
           const std::vector<float>& reach, Meter* meter)
      : samples_(samples),
        grid_(grid),
        reach_(reach),
        meter_(meter),
        speaker_(samples.size(), kLeft) {}

  std::vector<std::uint32_t> find() {
    // What shows detail comes first everywhere, so that nobody of longer reach takes it.
    const float least = *std::min_element(reach_.begin(), reach_.end());
    run([&](float reach) { return reach <= least; });
    run([&](float reach) { return reach > least; });
    return std::move(speaker_);
  }

 private:
  template <typename Chosen>
  void run(const Chosen& chosen) {
    grid_.for_each_block([&](const SampleGrid::Span& cells) {
      std::vector<std::uint32_t> around;
      std::uint32_t gathered = UINT32_MAX;
      const std::vector<Turn> turns = turns_of(cells, grid_, reach_);
      if (meter_) meter_->add(turns.size());
      for (const Turn& turn : turns) {
        if (speaker_[turn.sample] != kLeft || !chosen(turn.reach)) continue;
        speaker_[turn.sample] = turn.sample;
        if (turn.reach <= 0) continue;
        if (turn.cell != gathered) grid_.list_around(turn.cell, &around);
        gathered = turn.cell;
        take_around(turn, around);
      }
    });
  }

  void take_around(const Turn& turn, const std::vector<std::uint32_t>& around) {
    const Sample& s = samples_[turn.sample];
    const float most = turn.reach * s.pixel;
    for (const std::uint32_t i : around) {
      const float d2 = (samples_[i].position - s.position).squaredNorm();
      if (d2 <= most * most && speaker_[i] == kLeft) speaker_[i] = turn.sample;
    }
  }

  const std::vector<Sample>& samples_;
  const SampleGrid& grid_;
  const std::vector<float>& reach_;
  Meter* const meter_;
  std::vector<std::uint32_t> speaker_;
};

void take(Sample* speaker, const Sample& other) {
  speaker->weight += other.weight;
  speaker->color += (other.color - speaker->color) * (other.weight / speaker->weight);
  speaker->pixel = std::min(speaker->pixel, other.pixel);
  const Eigen::Vector3f offset = other.position - speaker->position;
  const float middle = (speaker->footprint + other.footprint) / 2;
  // What is nearer than its footprints adds only what the other does not cover.
  const float share = offset.squaredNorm() / std::max(middle * middle, 1e-20f);
  speaker->area += std::min(1.f, share) * other.area;
  speaker->footprint = std::max(speaker->footprint, other.footprint);
  speaker->spread = std::max(speaker->spread, offset.norm() + other.spread);
}

}  // namespace

std::vector<Sample> merged(const std::vector<Sample>& samples, const SampleGrid& grid,
                           const std::vector<float>& reach, Meter* meter) {
  if (samples.empty()) return {};
  const std::vector<std::uint32_t> speaker = Speakers(samples, grid, reach, meter).find();
  if (meter) meter->add(0);
  std::vector<std::uint32_t> place(samples.size());
  std::vector<Sample> result;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (speaker[i] != i) continue;
    place[i] = static_cast<std::uint32_t>(result.size());
    result.push_back(samples[i]);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (speaker[i] != i) take(&result[place[speaker[i]]], samples[i]);
  }
  return result;
}

}  // namespace ps
