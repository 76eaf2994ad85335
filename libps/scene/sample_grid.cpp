// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/sample_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr float kSeam = 1.04f;  ///< pixels of near neighbours seldom differ by more
constexpr int kBlockBits = 2;   ///< blocks are 4 cells wide
constexpr int kPlaces = 24;     ///< bits of a float
constexpr int kOriginBits = 8;
constexpr std::size_t kPhases = 16;
constexpr std::size_t kSteps = 1 << 14;  ///< samples between two words to the meter

/// The grid of a sample: cells of floats far from zero are not made finer than the floats are.
int level_of(const Sample& sample, float pixel) {
  const float far = std::max(sample.position.cwiseAbs().maxCoeff(), 1e-30f);
  return std::max(std::ilogb(pixel), std::ilogb(far) - kPlaces);
}

}  // namespace

SampleGrid::SampleGrid(const std::vector<Sample>& samples, float pixels, Meter* meter)
    : pixels_(pixels) {
  std::vector<std::uint32_t> cell_of(samples.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> guests;  // cell, sample
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (meter && i % kSteps == 0) meter->add(i == 0 ? 0 : kSteps);
    const Sample& s = samples[i];
    const int level = level_of(s, s.pixel);
    cell_of[i] = table_.find_or_add(key_of(s, level));
    const int finer = level_of(s, s.pixel / kSeam), coarser = level_of(s, s.pixel * kSeam);
    if (finer == coarser) continue;
    const int other = finer < level ? finer : coarser;
    guests.emplace_back(table_.find_or_add(key_of(s, other)), static_cast<std::uint32_t>(i));
  }
  fill_cells(cell_of, guests);
  fill_blocks(meter);
}

CellTable::Key SampleGrid::key_of(const Sample& sample, int level) const {
  const double inverse_width = std::ldexp(1.0 / pixels_, -level - 1);
  const auto step = [&](float x) {
    return static_cast<std::int32_t>(std::floor(x * inverse_width));
  };
  return {step(sample.position.x()), step(sample.position.y()), step(sample.position.z()),
          level * (1 << kOriginBits) + sample.origin};
}

void SampleGrid::fill_cells(const std::vector<std::uint32_t>& cell_of,
                            const std::vector<std::pair<std::uint32_t, std::uint32_t>>& guests) {
  const std::size_t cells = this->cells();
  std::vector<std::uint32_t> count(cells, 0);
  start_.assign(cells + 1, 0);
  guests_.assign(cells, 0);
  for (const std::uint32_t cell : cell_of) ++count[cell];
  for (std::size_t c = 0; c < cells; ++c) guests_[c] = count[c];
  for (const auto& guest : guests) ++count[guest.first];
  for (std::size_t c = 0; c < cells; ++c) {
    start_[c + 1] = start_[c] + count[c];
    guests_[c] += start_[c];
  }
  members_.resize(start_.back());
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < cell_of.size(); ++i) {
    members_[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
  }
  for (const auto& [cell, sample] : guests) members_[next[cell]++] = sample;
}

void SampleGrid::fill_blocks(Meter* meter) {
  KeyTable blocks;
  std::vector<std::uint32_t> block_of(cells());
  for (std::size_t c = 0; c < cells(); ++c) {
    if (meter && c % kSteps == 0) meter->add(0);
    CellTable::Key key = table_.keys()[c];
    for (std::size_t axis = 0; axis < 3; ++axis) key[axis] >>= kBlockBits;
    block_of[c] = blocks.find_or_add(key);
  }
  block_start_.assign(blocks.keys().size() + 1, 0);
  for (const std::uint32_t block : block_of) ++block_start_[block + 1];
  std::partial_sum(block_start_.begin(), block_start_.end(), block_start_.begin());
  block_cells_.resize(cells());
  std::vector<std::size_t> next(block_start_.begin(), block_start_.end() - 1);
  for (std::size_t c = 0; c < cells(); ++c) {
    block_cells_[next[block_of[c]]++] = static_cast<std::uint32_t>(c);
  }
  phases_.resize(kPhases);
  for (std::size_t b = 0; b < blocks.keys().size(); ++b) {
    const KeyTable::Key& key = blocks.keys()[b];
    const auto phase = static_cast<std::size_t>(
        (key[0] & 1) | (key[1] & 1) << 1 | (key[2] & 1) << 2 | (key[3] >> kOriginBits & 1) << 3);
    phases_[phase].push_back(static_cast<std::uint32_t>(b));
  }
}

void SampleGrid::list_around(std::size_t cell, std::vector<std::uint32_t>* around) const {
  around->clear();
  for (const std::uint32_t c : table_.around(table_.keys()[cell])) {
    if (c == CellTable::kNone) continue;
    around->insert(around->end(), members_.begin() + static_cast<std::ptrdiff_t>(start_[c]),
                   members_.begin() + static_cast<std::ptrdiff_t>(start_[c + 1]));
  }
}

void SampleGrid::for_each_block(const std::function<void(const Span& cells)>& body) const {
  for (const std::vector<std::uint32_t>& blocks : phases_) {
    parallel_for(blocks.size(), [&](std::size_t i) {
      const std::uint32_t* const cells = block_cells_.data();
      body({cells + block_start_[blocks[i]], cells + block_start_[blocks[i] + 1]});
    });
  }
}

}  // namespace ps
