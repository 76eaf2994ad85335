// SPDX-License-Identifier: BSD-3-Clause
// Weights as the upper halves of floats: half the memory to read, sums of single precision.
#include "libps/nn/kernels/simd.h"

namespace ps::nn {
namespace {

typedef uint16_t Halves __attribute__((vector_size(kVectorBytes / 2)));

inline Floats load_weights(const uint16_t* w) {
  const Halves halves = *reinterpret_cast<const Halves*>(w);
  return (Floats)(__builtin_convertvector(halves, Ints) << 16);
}

}  // namespace
}  // namespace ps::nn

#include "libps/nn/kernels/table.h"
#include "libps/nn/kernels/tile_loop.h"

namespace ps::nn {

void PS_KERNEL(tile_bf16)(const TileJob& job) { tile_of<uint16_t>(job); }

}  // namespace ps::nn
