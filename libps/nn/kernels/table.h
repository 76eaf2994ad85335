// SPDX-License-Identifier: BSD-3-Clause
// Internal to kernels/: what each source gives to the table of its instruction set.
#pragma once

#include "libps/nn/kernels/kernels.h"
#include "libps/nn/kernels/simd.h"

namespace ps::nn {

extern const int PS_KERNEL(most_vectors);
void PS_KERNEL(tile)(const TileJob& job);
void PS_KERNEL(tile_bf16)(const TileJob& job);
void PS_KERNEL(winograd_input)(const WinogradInput& job);
void PS_KERNEL(winograd_output)(const WinogradOutput& job);

}  // namespace ps::nn
