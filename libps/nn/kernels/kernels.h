// SPDX-License-Identifier: BSD-3-Clause
// Internal to the nn room: inner loops, compiled once for each instruction set. The sources include
// C headers and kernels/ alone, so that nothing inline can be shared between instruction sets.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace ps::nn {

constexpr int kTileRows = 6;

/// @brief One tile of a product: up to six rows by one panel of a PackedMatrix.
struct TileJob {
  const float* const* rows;  ///< [taps][kTileRows], each of `depth` floats
  const int* tap_index;      ///< [taps]: which of the weights' taps each is
  int taps, depth;
  int count;            ///< rows to compute, 1 to kTileRows
  const void* weights;  ///< the panel: [all taps][depth][columns padded to whole vectors], aligned
                        ///< to 64 bytes
  int columns;          ///< of the panel, at most Kernels::most_columns
  float* const* out;    ///< `count` pointers to a row's column 0; the panel begins at first_column
  const float* const* residual;  ///< like `out`, or null
  int first_column;
  const float *bias, *scale, *shift;  ///< from the panel's first column on; or null
  float slope;                        ///< of negative results
};

/// @brief Transforms of F(4x4, 3x3) for a run of channels (winograd.cpp).
struct WinogradInput {
  const float* const* pixels;  ///< [36], row by row; null = outside the image
  const float *scale, *shift;  ///< relu(x * scale + shift) is read in place of x; or null
  float* out;                  ///< 36 transformed values, each `channels` floats
  size_t step;                 ///< floats from one transformed value to the next
  int channels;
};
struct WinogradOutput {
  const float* in;  ///< 36 values, each `channels` floats
  size_t step;
  float* const* out;             ///< [16] pixels, row by row; null = outside the image
  const float* const* residual;  ///< [16], or null
  const float *bias, *scale, *shift;
  float slope;
  int channels;
};

/// @brief Elementwise loops over `count` values; out may be in.
struct Kernels {
  int vector_width;  ///< floats
  int most_vectors;  ///< in a panel
  void (*tile)(const TileJob&);
  void (*tile_bf16)(const TileJob&);
  void (*winograd_input)(const WinogradInput&);
  void (*winograd_output)(const WinogradOutput&);

  void (*activate)(const float* in, float* out, size_t count, float slope);
  void (*elu)(const float* in, float* out, size_t count, float sign);  ///< elu(sign * x)
  void (*tanh)(const float* in, float* out, size_t count);
  void (*sigmoid)(const float* in, float* out, size_t count);
  void (*exp)(const float* in, float* out, size_t count);
  /// out = in * scale + shift, times slope where negative; scale and shift have `count` values
  void (*scale_shift)(const float* in, const float* scale, const float* shift, float* out,
                      size_t count, float slope);
  void (*add)(const float* a, const float* b, float* out, size_t count, float slope);
  /// out = base + value * sigmoid(gate)
  void (*gated_add)(const float* base, const float* value, const float* gate, float* out,
                    size_t count);
  /// out = wa * a + wb * b
  void (*mix)(const float* a, const float* b, float wa, float wb, float* out, size_t count);
  /// out = max(a, b)
  void (*maximum)(const float* a, const float* b, float* out, size_t count);
};

const Kernels& kernels_baseline();
const Kernels& kernels_avx2();
const Kernels& kernels_avx512();

/// @return the kernels in use (isa.h)
const Kernels& kernels();

}  // namespace ps::nn
