// SPDX-License-Identifier: BSD-3-Clause
// Internal to kernels/: the elementwise loops of one instruction set; see Kernels in kernels.h.
#pragma once

#include "libps/nn/kernels/simd.h"

namespace ps::nn {

void PS_KERNEL(activate)(const float* in, float* out, size_t count, float slope);
void PS_KERNEL(elu)(const float* in, float* out, size_t count, float sign);
void PS_KERNEL(tanh)(const float* in, float* out, size_t count);
void PS_KERNEL(sigmoid)(const float* in, float* out, size_t count);
void PS_KERNEL(exp)(const float* in, float* out, size_t count);
void PS_KERNEL(scale_shift)(const float* in, const float* scale, const float* shift, float* out,
                            size_t count, float slope);
void PS_KERNEL(add)(const float* a, const float* b, float* out, size_t count, float slope);
void PS_KERNEL(gated_add)(const float* base, const float* value, const float* gate, float* out,
                          size_t count);
void PS_KERNEL(mix)(const float* a, const float* b, float wa, float wb, float* out, size_t count);
void PS_KERNEL(maximum)(const float* a, const float* b, float* out, size_t count);

}  // namespace ps::nn
