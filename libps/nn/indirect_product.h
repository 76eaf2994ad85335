// SPDX-License-Identifier: BSD-3-Clause
// Internal to the library (the sampler multiplies so, too): a product of rows that lie scattered in
// memory, on all threads.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "libps/nn/packed_matrix.h"
#include "libps/nn/tensor.h"

namespace ps::nn {

/// Where the rows of a product lie. Rows come in groups of at most kSlots, so that what is found
/// out about a group is shared by all panels of the matrix.
struct IndirectRows {
  static constexpr std::size_t kSlots = 240;

  std::size_t count = 0;
  int taps = 1;  ///< pointers of a row: into how many PackedMatrix::multiply cuts it
  /// (begin, end, pointers): sets pointers[slot_of(row - begin, tap, taps)] for every row and tap;
  /// null stands for zeros.
  std::function<void(std::size_t begin, std::size_t end, const float** pointers)> sources;
  /// The pixel of `out` that a row becomes; none = the row's own number.
  std::function<std::size_t(std::size_t row)> target = {};
};

/// @return the place of a row's pointer for a tap: tiles of kRows rows, within them tap by tap
inline std::size_t slot_of(std::size_t row, int tap, int taps) {
  constexpr std::size_t kRows = PackedMatrix::kRows;
  return (row / kRows * static_cast<std::size_t>(taps) + static_cast<std::size_t>(tap)) * kRows +
         row % kRows;
}

/// @brief Every row times the matrix, into its pixel of `out`.
void indirect_product(const PackedMatrix& matrix, const IndirectRows& rows, const TensorView& out,
                      const Epilogue& epilogue);

/// @brief Throws ps::Error unless the two shapes are the same; `what` names the operator.
void check_same(const Shape& got, const Shape& wanted, const char* what);

/// @return the epilogue with an operator's own bias; throws ps::Error when it has one already, a
/// scale without a shift or the reverse, or a residual of another shape than the output
Epilogue with_bias(const Epilogue& given, const std::vector<float>& bias, const Shape& out,
                   const char* what);

/// @brief A bias is there, with one value for each channel, or it is empty; else throws ps::Error.
void check_bias(const std::vector<float>& bias, std::size_t channels, const char* what);

}  // namespace ps::nn
