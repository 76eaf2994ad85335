// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/sample_grid.h"

#include <algorithm>
#include <cmath>

#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr float kSeam = 1.04f;  ///< pixels of near neighbours seldom differ by more
constexpr int kBlockBits = 2;   ///< blocks are 4 cells wide
constexpr int kPlaces = 24;     ///< bits of a float
constexpr int kOriginBits = 8;
constexpr std::size_t kPhases = 16;

std::size_t hash_of(const KeyTable::Key& key) {
  std::uint64_t h = 0;
  for (const std::int32_t k : key) {
    h = (h ^ static_cast<std::uint32_t>(k)) * 0x9e3779b97f4a7c15;
    h ^= h >> 29;
  }
  return h;
}

/// The grid of a sample: cells of floats far from zero are not made finer than the floats are.
int level_of(const Sample& sample, float pixel) {
  const float far = std::max(sample.position.cwiseAbs().maxCoeff(), 1e-30f);
  return std::max(std::ilogb(pixel), std::ilogb(far) - kPlaces);
}

}  // namespace

std::size_t KeyTable::slot_of(const Key& key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(key) & mask;
  while (slots_[slot] != kNone && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t KeyTable::find(const Key& key) const {
  return slots_.empty() ? kNone : slots_[slot_of(key)];
}

std::uint32_t KeyTable::find_or_add(const Key& key) {
  if (2 * keys_.size() >= slots_.size()) {
    slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), kNone);  // stays a power of two
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      slots_[slot_of(keys_[i])] = static_cast<std::uint32_t>(i);
    }
  }
  std::uint32_t& slot = slots_[slot_of(key)];
  if (slot == kNone) {
    slot = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(key);
  }
  return slot;
}

SampleGrid::SampleGrid(const std::vector<Sample>& samples, float pixels) : pixels_(pixels) {
  std::vector<std::uint32_t> cell_of(samples.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> guests;  // cell, sample
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& s = samples[i];
    const int level = level_of(s, s.pixel);
    cell_of[i] = table_.find_or_add(key_of(s, level));
    const int finer = level_of(s, s.pixel / kSeam), coarser = level_of(s, s.pixel * kSeam);
    if (finer == coarser) continue;
    const int other = finer < level ? finer : coarser;
    guests.emplace_back(table_.find_or_add(key_of(s, other)), static_cast<std::uint32_t>(i));
  }
  fill_cells(cell_of, guests);
  fill_blocks();
}

KeyTable::Key SampleGrid::key_of(const Sample& sample, int level) const {
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

void SampleGrid::fill_blocks() {
  KeyTable blocks;
  phases_.resize(kPhases);
  std::vector<std::vector<std::uint32_t>*> block_cells;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;  // phase, number in it
  for (std::size_t c = 0; c < cells(); ++c) {
    KeyTable::Key key = table_.keys()[c];
    for (int axis = 0; axis < 3; ++axis) key[axis] >>= kBlockBits;
    const std::uint32_t block = blocks.find_or_add(key);
    if (block == places.size()) {
      const std::uint32_t phase =
          (key[0] & 1) | (key[1] & 1) << 1 | (key[2] & 1) << 2 | (key[3] >> kOriginBits & 1) << 3;
      places.emplace_back(phase, static_cast<std::uint32_t>(phases_[phase].size()));
      phases_[phase].emplace_back();
    }
    phases_[places[block].first][places[block].second].push_back(static_cast<std::uint32_t>(c));
  }
}

void SampleGrid::list_around(std::size_t cell, std::vector<std::uint32_t>* around) const {
  around->clear();
  const KeyTable::Key& key = table_.keys()[cell];
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const std::uint32_t c = table_.find({key[0] + dx, key[1] + dy, key[2] + dz, key[3]});
        if (c == KeyTable::kNone) continue;
        around->insert(around->end(), members_.begin() + start_[c],
                       members_.begin() + start_[c + 1]);
      }
    }
  }
}

void SampleGrid::for_each_block(
    const std::function<void(const std::vector<std::uint32_t>&)>& body) const {
  for (const auto& blocks : phases_) {
    parallel_for(blocks.size(), [&](std::size_t i) { body(blocks[i]); });
  }
}

}  // namespace ps
