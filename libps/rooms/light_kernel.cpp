// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set (PS_ISA). C headers only: nothing inline may be shared.
// Loops over the places of a packet are left to the compiler to turn into vectors.
#include "libps/rooms/light_kernel.h"

#include <math.h>

#define PS_JOIN2(a, b) a##b
#define PS_JOIN(a, b) PS_JOIN2(a, b)

namespace ps {
namespace rooms {
namespace light_kernel {

void PS_JOIN(weigh_, PS_ISA)(const Lamp* lamps, int count, const Places& p, float bright,
                             float (*rates)[kRays], float* all, float* total) {
  alignas(64) float sum[kRays], light[kRays];
  for (int i = 0; i < kRays; ++i) sum[i] = light[i] = 0;
  for (int e = 0; e < count; ++e) {
    const Lamp& lamp = lamps[e];
    const float size = lamp.radius * lamp.radius, over = 0.3f * lamp.radius, round = lamp.round;
    float* out = rates[e];
    for (int i = 0; i < kRays; ++i) {
      const float x = lamp.center[0] - p.x[i], y = lamp.center[1] - p.y[i],
                  z = lamp.center[2] - p.z[i];
      const float square = x * x + y * y + z * z, d2 = square > 0.01f ? square : 0.01f;
      const float s = p.nx[i] * x + p.ny[i] * y + p.nz[i] * z + over;
      const float flat = -(lamp.normal[0] * x + lamp.normal[1] * y + lamp.normal[2] * z);
      const float l = round * sqrtf(d2) + (1 - round) * flat;
      const float rate = lamp.area * (s > 0 ? s : 0.f) * (l > 0 ? l : 0.f) / (d2 * (d2 + size));
      out[i] = rate;
      sum[i] += rate;
      light[i] += rate * bright;
    }
  }
  for (int i = 0; i < kRays; ++i) {
    all[i] = sum[i];
    total[i] = light[i];
  }
}

}  // namespace light_kernel
}  // namespace rooms
}  // namespace ps
