// SPDX-License-Identifier: BSD-3-Clause
// Internal to kernels/: the product of a tile, for weights of any storage.
#pragma once

#include "libps/nn/kernels/kernels.h"
#include "libps/nn/kernels/simd.h"

namespace ps::nn {
namespace {

#if defined(__AVX512F__)
constexpr int kMostVectors = 4;  ///< six rows by four vectors: 24 sums, and registers to spare
#else
constexpr int kMostVectors = 2;
#endif

/// Everything between a sum and memory; see Epilogue in packed_matrix.h. `count` columns of a
/// vector.
inline void finish(const TileJob& job, int row, int column, int count, Floats sum) {
  const auto read = [&](const float* p) { return count == kLanes ? load(p) : load_part(p, count); };
  if (job.bias) sum += read(job.bias + column);
  if (job.scale) sum = multiply_add(sum, read(job.scale + column), read(job.shift + column));
  const int at = job.first_column + column;
  if (job.residual) sum += read(job.residual[row] + at);
  if (job.slope != 1.0f) sum = activated(sum, all(job.slope));
  if (count == kLanes) {
    store(job.out[row] + at, sum);
  } else {
    store_part(job.out[row] + at, sum, count);
  }
}

/// All of a tile; not inlined, so that sums stay in registers where this is not needed.
__attribute__((noinline)) void finish_all(const TileJob& job, int rows, int vectors,
                                          const Floats* sums) {
  for (int r = 0; r < rows; ++r) {
    for (int v = 0; v < vectors; ++v) {
      const int left = job.columns - v * kLanes;
      finish(job, r, v * kLanes, left < kLanes ? left : kLanes, sums[r * vectors + v]);
    }
  }
}

/// R rows by V vectors of columns. `Weight` is how a weight is stored; load_weights reads a vector.
template <int R, int V, class Weight>
void product(const TileJob& job) {
  Floats sum[R][V];
#pragma GCC unroll 6
  for (int r = 0; r < R; ++r) {
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v) sum[r][v] = Floats{};
  }
  const size_t tap_weights = static_cast<size_t>(job.depth) * V * kLanes;
  for (int tap = 0; tap < job.taps; ++tap) {
    const Weight* weights = static_cast<const Weight*>(job.weights) +
                            static_cast<size_t>(job.tap_index[tap]) * tap_weights;
    const float* rows[R];
#pragma GCC unroll 6
    for (int r = 0; r < R; ++r) rows[r] = job.rows[tap * kTileRows + r];
    for (int i = 0; i < job.depth; ++i) {
      Floats w[V];
#pragma GCC unroll 4
      for (int v = 0; v < V; ++v) w[v] = load_weights(weights + v * kLanes);
      weights += V * kLanes;
#pragma GCC unroll 6
      for (int r = 0; r < R; ++r) {
        const Floats x = all(rows[r][i]);
#pragma GCC unroll 4
        for (int v = 0; v < V; ++v) sum[r][v] = multiply_add(x, w[v], sum[r][v]);
      }
    }
  }
  if (job.columns == V * kLanes && !job.scale && !job.residual) {  // most products
    const Floats slope = all(job.slope);
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v) {
      const Floats bias = job.bias ? load(job.bias + v * kLanes) : Floats{};
#pragma GCC unroll 6
      for (int r = 0; r < R; ++r) {
        store(job.out[r] + job.first_column + v * kLanes, activated(sum[r][v] + bias, slope));
      }
    }
    return;
  }
  Floats sums[R * V];
#pragma GCC unroll 6
  for (int r = 0; r < R; ++r) {
#pragma GCC unroll 4
    for (int v = 0; v < V; ++v) sums[r * V + v] = sum[r][v];
  }
  finish_all(job, R, V, sums);
}

template <int V, class Weight>
void product_of_rows(const TileJob& job) {
  switch (job.count) {
    case 1:
      return product<1, V, Weight>(job);
    case 2:
      return product<2, V, Weight>(job);
    case 3:
      return product<3, V, Weight>(job);
    case 4:
      return product<4, V, Weight>(job);
    case 5:
      return product<5, V, Weight>(job);
    default:
      return product<6, V, Weight>(job);
  }
}

template <class Weight>
void tile_of(const TileJob& job) {
  switch ((job.columns + kLanes - 1) / kLanes) {
    case 1:
      return product_of_rows<1, Weight>(job);
    case 2:
      return product_of_rows<2, Weight>(job);
#if defined(__AVX512F__)
    case 3:
      return product_of_rows<3, Weight>(job);
    default:
      return product_of_rows<4, Weight>(job);
#else
    default:
      return;
#endif
  }
}

}  // namespace
}  // namespace ps::nn
