// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: who is near whom, where "near" is a number of pixels.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "libps/scene/cell_table.h"
#include "libps/scene/sample.h"

namespace ps {

/// @brief Samples in cubes of space whose sides are `pixels` to twice that, in each sample's own
/// pixels: one grid for each power of two of the pixel, and each origin.
///
/// A sample whose pixel is next to a power of two is in two grids, so that grids leave no seams; in
/// one of them it is a guest.
class SampleGrid {
 public:
  /// A range of numbers of samples.
  struct Span {
    const std::uint32_t *first, *last;
    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
    std::size_t size() const { return static_cast<std::size_t>(last - first); }
  };

  /// @param meter  if given, told of samples, as parts of its stage
  SampleGrid(const std::vector<Sample>& samples, float pixels, Meter* meter = nullptr);

  std::size_t cells() const { return table_.keys().size(); }

  /// @return the samples of a cell, guests left out; each sample is in one cell
  Span own(std::size_t cell) const {
    return {members_.data() + start_[cell], members_.data() + guests_[cell]};
  }

  /// @brief Lists all samples of a cell and its 26 neighbours: among them are all within `pixels`
  /// of any of its own.
  void list_around(std::size_t cell, std::vector<std::uint32_t>* around) const;

  /// @brief Calls `body(cells)` for all cells, in blocks of 4 x 4 x 4, on all threads. No two
  /// blocks that run at the same time have a sample in common in their cells or next to them.
  void for_each_block(const std::function<void(const Span& cells)>& body) const;

 private:
  CellTable::Key key_of(const Sample& sample, int level) const;
  void fill_cells(const std::vector<std::uint32_t>& cell_of,
                  const std::vector<std::pair<std::uint32_t, std::uint32_t>>& guests);
  void fill_blocks(Meter* meter);

  float pixels_;
  CellTable table_;
  std::vector<std::size_t> start_;   ///< of each cell in members_, and the end of the last
  std::vector<std::size_t> guests_;  ///< of each cell, where its guests start
  std::vector<std::uint32_t> members_;
  std::vector<std::size_t> block_start_;  ///< of each block in block_cells_, and the last one's end
  std::vector<std::uint32_t> block_cells_;
  std::vector<std::vector<std::uint32_t>> phases_;  ///< blocks that may run at the same time
};

}  // namespace ps
