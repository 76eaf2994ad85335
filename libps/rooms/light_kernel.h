// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: how bright lamps are at the places of a packet, built for several
// vector widths. Every width does the same operations in the same order: same bytes.
#pragma once

#include "libps/rooms/trace_kernel.h"

namespace ps {
namespace rooms {
namespace light_kernel {

/// The places of a packet, and the normals of their surfaces.
struct alignas(64) Places {
  float x[kRays], y[kRays], z[kRays], nx[kRays], ny[kRays], nz[kRays];
};

/// A lamp as it is weighed: flat, or a ball that shines the same way all around.
struct Lamp {
  float center[3], normal[3];
  float area, radius;
  float round;  ///< 1 = a ball, 0 = flat
};

/// About what each lamp would send to each place if nothing stood between.
/// @param rates  for each lamp
/// @param all    the sum of the rates at each place
/// @param total  the sum of the rates times `bright`
typedef void Weigh(const Lamp* lamps, int count, const Places& places, float bright,
                   float (*rates)[kRays], float* all, float* total);

Weigh weigh_baseline, weigh_avx2, weigh_avx512;

}  // namespace light_kernel
}  // namespace rooms
}  // namespace ps
