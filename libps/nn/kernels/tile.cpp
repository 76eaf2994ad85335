// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/kernels/simd.h"

namespace ps::nn {
namespace {
inline Floats load_weights(const float* w) { return *reinterpret_cast<const Floats*>(w); }
}  // namespace
}  // namespace ps::nn

#include "libps/nn/kernels/table.h"
#include "libps/nn/kernels/tile_loop.h"

namespace ps::nn {

extern const int PS_KERNEL(most_vectors) = kMostVectors;
void PS_KERNEL(tile)(const TileJob& job) { tile_of<float>(job); }

}  // namespace ps::nn
