// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set (PS_ISA). C headers only: nothing inline may be shared.
// Loops are left to the compiler to turn into vectors.
#include "libps/rooms/plane_kernel.h"

#include <math.h>

#include "libps/rooms/lanes.h"

#define PS_JOIN2(a, b) a##b
#define PS_JOIN(a, b) PS_JOIN2(a, b)

namespace ps {
namespace rooms {
namespace plane_kernel {
namespace {

/// Loops go over so many pixels at a time, by arrays of their own: the compiler sees that these
/// overlap with nothing.
constexpr int kPart = 64;

inline void put(const float* from, int count, float* to) {
  for (int i = 0; i < count; ++i) to[i] = from[i];
}
inline float luminance(float r, float g, float b) {
  return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

}  // namespace

void PS_JOIN(share_, PS_ISA)(const Stretch* taps, float* const* out, int count) {
  static const float kWeights[5] = {0.5f, 1, 1, 1, 0.5f};
  static_assert(kStep % kLanes == 0, "vectors end where steps do");
  for (int i = 0; i < count; i += kLanes) {
    const Marks here = load(taps[2].surface + i);
    Lanes red = {}, green = {}, blue = {}, total = {};
    for (int t = 0; t < 5; ++t) {
      const Stretch& tap = taps[t];
      const Lanes weight = load(tap.surface + i) == here ? all_lanes(kWeights[t]) : all_lanes(0);
      red += load(tap.value[0] + i) * weight;
      green += load(tap.value[1] + i) * weight;
      blue += load(tap.value[2] + i) * weight;
      total += weight;
    }
    const Lanes inverse = 1 / total;
    store(out[0] + i, red * inverse);
    store(out[1] + i, green * inverse);
    store(out[2] + i, blue * inverse);
  }
}

void PS_JOIN(share_alike_, PS_ISA)(const Stretch* taps, float* const* out, int count) {
  const Stretch& own = taps[1];
  for (int first = 0; first < count; first += kPart) {
    const int n = count - first < kPart ? count - first : kPart;
    const float *x = own.value[0] + first, *y = own.value[1] + first, *z = own.value[2] + first;
    float red[kPart], green[kPart], blue[kPart], total[kPart];
    for (int i = 0; i < n; ++i) {
      red[i] = x[i] * 2;
      green[i] = y[i] * 2;
      blue[i] = z[i] * 2;
      total[i] = 2;
    }
    for (int t = 0; t <= 2; t += 2) {
      const float *r = taps[t].value[0] + first, *g = taps[t].value[1] + first,
                  *b = taps[t].value[2] + first;
      const int32_t *surface = taps[t].surface + first, *here = own.surface + first;
      for (int i = 0; i < n; ++i) {
        const float like = surface[i] == here[i] ? 1.f : 0.f;
        const float light = luminance(x[i], y[i], z[i]), there = luminance(r[i], g[i], b[i]);
        const float differs = (there - light) / (0.1f * (there + light) + 1e-6f);
        const float weight = like * (1 / (1 + differs * differs));
        red[i] += r[i] * weight;
        green[i] += g[i] * weight;
        blue[i] += b[i] * weight;
        total[i] += weight;
      }
    }
    for (int i = 0; i < n; ++i) {
      const float inverse = 1 / total[i];
      red[i] *= inverse;
      green[i] *= inverse;
      blue[i] *= inverse;
    }
    put(red, n, out[0] + first);
    put(green, n, out[1] + first);
    put(blue, n, out[2] + first);
  }
}

void PS_JOIN(look_, PS_ISA)(const Curve& curve, const float* in, float* out, int count) {
  const float *values = curve.values, most = curve.most, steps = static_cast<float>(curve.steps);
  for (int first = 0; first < count; first += kPart) {
    const int n = count - first < kPart ? count - first : kPart;
    float at[kPart];
    for (int i = 0; i < n; ++i) {
      const float x = in[first + i] / most, above = x > 0.f ? x : 0.f;
      at[i] = above < 0.9999f ? above : 0.9999f;
    }
    if (curve.root) {
      for (int i = 0; i < n; ++i) at[i] = sqrtf(at[i]);
    }
    float found[kPart];
    for (int i = 0; i < n; ++i) {
      const float place = at[i] * steps;
      const int k = static_cast<int>(place);
      const float t = place - static_cast<float>(k);
      found[i] = values[k] * (1 - t) + values[k + 1] * t;
    }
    put(found, n, out + first);
  }
}

}  // namespace plane_kernel
}  // namespace rooms
}  // namespace ps
