// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

#include "libps/nn/activation.h"
#include "libps/nn/tensor.h"

namespace ps::nn {

struct Kernels;

/// How weights are kept in memory; sums are always of single precision.
enum class Storage { f32, bf16 };

/// @brief What happens to a sum before it is stored, for each output channel:
/// v = sum + bias; v = v * scale + shift; v += residual; v = activation(v). Null = left out.
/// Vectors have as many values as the output has channels.
struct Epilogue {
  const float* bias = nullptr;
  const float* scale = nullptr;
  const float* shift = nullptr;
  const TensorView* residual = nullptr;  ///< of the output's shape; may be the output itself
  Activation activation = {};
};

/// @brief A matrix of taps * depth rows and some columns, packed for the machine's vector width.
///
/// It multiplies rows that are given as pointers: `depth` floats for each tap. What a convolution
/// reads outside the image, or what a local mask hides, is a pointer to zeros or a tap left out; so
/// every convolution of this room is this one product. A sum is taken tap by tap and, within a tap,
/// from the first channel on, in one chain: it does not depend on how many rows are multiplied at
/// once, on threads, or on the row's place. After Dukhan, "The Indirect Convolution Algorithm"
/// (2019).
class PackedMatrix {
 public:
  PackedMatrix() = default;
  /// @param value  (tap, row within the tap, column) -> the matrix's value
  PackedMatrix(int taps, int depth, int columns,
               const std::function<float(int tap, int row, int column)>& value,
               Storage storage = Storage::f32);

  int taps() const { return taps_; }
  int depth() const { return depth_; }
  int columns() const { return columns_; }
  std::size_t rows() const {
    return static_cast<std::size_t>(taps_) * static_cast<std::size_t>(depth_);
  }
  int panels() const { return panels_; }
  std::size_t bytes() const;
  const float* zeros() const { return zeros_.get(); }  ///< rows() of them

  static constexpr int kRows = 6;
  static constexpr int kOnlyTap = 0;  ///< tap_index of a row of one tap

  /// The rows of one tile: `count` of them, and of each the taps that are not all zeros.
  struct Tile {
    const float* const* rows;  ///< [taps][kRows] pointers; of each tap, the first `count` count
    const int* tap_index;      ///< [taps], rising: which taps these are; the others are zeros
    int taps;
    int count;
    float* const* out;             ///< `count` pointers to a row's column 0
    const float* const* residual;  ///< the same, or null
  };

  /// @brief Multiplies up to kRows rows with panels [first, last) of columns.
  /// @param cut  into how many taps a row is cut here: taps(), or, where the floats of several taps
  /// lie
  ///             behind each other in memory, a divisor of it
  void multiply(const Tile& tile, int cut, const Epilogue& epilogue, int first_panel,
                int last_panel) const;

 private:
  int taps_ = 0, depth_ = 0, columns_ = 0;
  int panels_ = 0;
  int panel_ = 0;  ///< columns of every panel but the last: whole vectors
  Storage storage_ = Storage::f32;
  AlignedFloats values_;  ///< panel by panel: [taps][depth][columns, padded to whole vectors]
  std::size_t count_ = 0;
  AlignedFloats zeros_;
  const Kernels* kernels_ = nullptr;  ///< those that it was packed for
};

}  // namespace ps::nn
