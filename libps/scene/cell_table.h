// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: which cells of space there are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace ps {

/// Numbers for keys, in the order in which they first come.
class KeyTable {
 public:
  using Key = std::array<std::int32_t, 4>;
  static constexpr std::uint32_t kNone = UINT32_MAX;

  std::uint32_t find(const Key& key) const;
  std::uint32_t find_or_add(const Key& key);
  const std::vector<Key>& keys() const { return keys_; }

 private:
  /// Half of the hash stands beside the number: keys that differ are seldom fetched to tell so.
  struct Slot {
    std::uint32_t number = kNone;  ///< kNone = free
    std::uint32_t hash = 0;
  };
  std::size_t slot_of(const Key& key, std::uint64_t hash) const;

  std::vector<Key> keys_;
  std::vector<Slot> slots_;     ///< a power of two of them
  std::uint32_t last_ = kNone;  ///< that was asked for or added: the next is often the same
};

/// @brief Numbers for the cells of grids, in the order in which they first come; a key is x, y, z
/// and which grid it is. Cells are kept in cubes of 2 x 2 x 2, so that a cell's neighbours take 8
/// look-ups and not 27.
class CellTable {
 public:
  using Key = KeyTable::Key;
  static constexpr std::uint32_t kNone = KeyTable::kNone;
  using Around = std::array<std::uint32_t, 27>;

  std::uint32_t find_or_add(const Key& key);
  const std::vector<Key>& keys() const { return keys_; }
  /// @return a cell and those around it in its grid, along x first, then y; kNone = there is none
  Around around(const Key& key) const;

 private:
  using Cube = std::array<std::uint32_t, 8>;

  KeyTable table_;           ///< of cubes
  std::vector<Cube> cubes_;  ///< numbers of their cells
  std::vector<Key> keys_;    ///< of cells
};

}  // namespace ps
