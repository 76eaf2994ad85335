// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/cell_table.h"

#include <algorithm>

namespace ps {
namespace {

using Key = KeyTable::Key;

std::uint64_t hash_of(const Key& key) {
  std::uint64_t h = 0;
  for (const std::int32_t k : key) {
    h = (h ^ static_cast<std::uint32_t>(k)) * 0x9e3779b97f4a7c15;
    h ^= h >> 29;
  }
  return h;
}

std::uint32_t high_half(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> 32); }

/// What == of arrays would call memcmp() for.
bool same(const Key& a, const Key& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
}

Key cube_of(const Key& cell) { return {cell[0] >> 1, cell[1] >> 1, cell[2] >> 1, cell[3]}; }

/// @return the place in its cube
std::size_t place_of(std::int32_t x, std::int32_t y, std::int32_t z) {
  return static_cast<std::size_t>((x & 1) | (y & 1) << 1 | (z & 1) << 2);
}

}  // namespace

std::size_t KeyTable::slot_of(const Key& key, std::uint64_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hash & mask;
  for (; slots_[at].number != kNone; at = (at + 1) & mask) {
    if (slots_[at].hash == high_half(hash) && same(keys_[slots_[at].number], key)) break;
  }
  return at;
}

std::uint32_t KeyTable::find(const Key& key) const {
  return slots_.empty() ? kNone : slots_[slot_of(key, hash_of(key))].number;
}

std::uint32_t KeyTable::find_or_add(const Key& key) {
  if (last_ != kNone && same(keys_[last_], key)) return last_;
  if (2 * keys_.size() >= slots_.size()) {
    slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), {});  // stays a power of two
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      const std::uint64_t hash = hash_of(keys_[i]);
      slots_[slot_of(keys_[i], hash)] = {static_cast<std::uint32_t>(i), high_half(hash)};
    }
  }
  const std::uint64_t hash = hash_of(key);
  Slot& slot = slots_[slot_of(key, hash)];
  if (slot.number == kNone) {
    slot = {static_cast<std::uint32_t>(keys_.size()), high_half(hash)};
    keys_.push_back(key);
  }
  return last_ = slot.number;
}

std::uint32_t CellTable::find_or_add(const Key& key) {
  const std::uint32_t cube = table_.find_or_add(cube_of(key));
  if (cube == cubes_.size()) {
    cubes_.emplace_back();
    cubes_.back().fill(kNone);
  }
  std::uint32_t& cell = cubes_[cube][place_of(key[0], key[1], key[2])];
  if (cell == kNone) {
    cell = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(key);
  }
  return cell;
}

CellTable::Around CellTable::around(const Key& key) const {
  const Key first = cube_of({key[0] - 1, key[1] - 1, key[2] - 1, key[3]});
  Cube cubes;  // the two along each axis that three cells in a row lie in
  for (std::int32_t i = 0; i < 8; ++i) {
    cubes[static_cast<std::size_t>(i)] =
        table_.find({first[0] + (i & 1), first[1] + (i >> 1 & 1), first[2] + (i >> 2), first[3]});
  }
  Around around;
  std::size_t next = 0;
  for (std::int32_t z = key[2] - 1; z <= key[2] + 1; ++z) {
    for (std::int32_t y = key[1] - 1; y <= key[1] + 1; ++y) {
      for (std::int32_t x = key[0] - 1; x <= key[0] + 1; ++x) {
        const std::uint32_t cube =
            cubes[place_of((x >> 1) - first[0], (y >> 1) - first[1], (z >> 1) - first[2])];
        around[next++] = cube == kNone ? kNone : cubes_[cube][place_of(x, y, z)];
      }
    }
  }
  return around;
}

}  // namespace ps
