// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/train/parameters.h"

namespace ps::train {

/// @brief Which cell each tap of each cell reads, and the other way round, for orders of a batch:
/// row numbers [rows * 9], -1 = hidden or outside (SPEC.md 6).
struct TapIndex {
  Tensor from;  ///< by (cell, tap): the row that it reads
  Tensor to;    ///< by (cell, tap): the (cell, tap) that reads this cell through that tap
};

/// @param order   [n, h * w] int64: cells from first to last
/// @param centre  whether the cell itself is visible
TapIndex tap_index(const Tensor& order, int height, int width, int dilation, bool centre);

/// @brief The PixelCNN in training (SPEC.md 7; `outpaint2.*`; models::PixelCnn runs it).
class PixelCnn {
 public:
  PixelCnn(int f, int codes, std::uint64_t seed);
  /// Beside the network's own: `code_counts`, how often training saw each code.
  Parameters parameters;

  int codes() const { return codes_; }

  /// @param codes  [n, h, w] int64   @param order  [n, h * w] int64
  /// @return logits [n * h * w, codes]: of each cell, given those earlier in the order
  Tensor forward(const Tensor& codes, const Tensor& order) const;

 private:
  int codes_;
};

}  // namespace ps::train
