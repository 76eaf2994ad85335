// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set (PS_ISA). C headers only: nothing inline may be shared.
// Loops are left to the compiler to turn into vectors.
#include "libps/rooms/effects_kernel.h"

#include "libps/rooms/lanes.h"

#define PS_JOIN2(a, b) a##b
#define PS_JOIN(a, b) PS_JOIN2(a, b)

namespace ps {
namespace rooms {
namespace effects_kernel {
namespace {

inline float within_one(float x) { return x < 0.f ? 0.f : 1.f < x ? 1.f : x; }

typedef float Eight __attribute__((vector_size(32), aligned(4), may_alias));

inline Eight load_eight(const float* p) { return *reinterpret_cast<const Eight*>(p); }

/// Rows, then columns, times a matrix of [from][to].
inline void transform(const Eight* in, const float* matrix, Eight* out) {
  Eight rows[8], m[8];
  for (int i = 0; i < 8; ++i) m[i] = load_eight(matrix + 8 * i);
  for (int r = 0; r < 8; ++r) {
    Eight sum = {};
    for (int i = 0; i < 8; ++i) sum += in[r][i] * m[i];
    rows[r] = sum;
  }
  for (int k = 0; k < 8; ++k) {
    Eight sum = {};
    for (int i = 0; i < 8; ++i) sum += rows[i] * matrix[8 * i + k];
    out[k] = sum;
  }
}

}  // namespace

void PS_JOIN(tint_, PS_ISA)(float* rgb, const float* light, const float* gains, float saturation,
                            int pixels) {
  const float red = gains[0], green = gains[1], blue = gains[2];
  for (int i = 0; i < pixels; ++i) {
    const float r0 = rgb[3 * i] * red * light[i];
    const float g0 = rgb[3 * i + 1] * green * light[i];
    const float b0 = rgb[3 * i + 2] * blue * light[i];
    const float r = r0 < 1.f ? r0 : 1.f, g = g0 < 1.f ? g0 : 1.f, b = b0 < 1.f ? b0 : 1.f;
    const float grey = 0.3f * r + 0.59f * g + 0.11f * b;
    rgb[3 * i] = within_one(grey + (r - grey) * saturation);
    rgb[3 * i + 1] = within_one(grey + (g - grey) * saturation);
    rgb[3 * i + 2] = within_one(grey + (b - grey) * saturation);
  }
}

void PS_JOIN(weigh_, PS_ISA)(const float* const* taps, const float* weights, int count, float total,
                             float* out, int floats) {
  int i = 0;
  for (; i + kLanes <= floats; i += kLanes) {
    Lanes sum = {};
    for (int t = 0; t < count; ++t) sum += load(taps[t] + i) * weights[t];
    store(out + i, sum / total);
  }
  for (; i < floats; ++i) {
    float sum = 0;
    for (int t = 0; t < count; ++t) sum += taps[t][i] * weights[t];
    out[i] = sum / total;
  }
}

void PS_JOIN(grain_, PS_ISA)(Streams* streams, float* rgb, float sigma, float colored, int pixels) {
  constexpr int kPixels = kStreams / 4;
  const float shared_share = 1 - colored;
  for (int first = 0; first < pixels; first += kPixels) {
    float z[kStreams];
    for (int i = 0; i < kStreams; ++i) {
      const uint64_t s = streams->state[i], x = s ^ s >> 29;
      const uint64_t sum = (x & 0xffff) + (x >> 16 & 0xffff) + (x >> 32 & 0xffff) + (x >> 48);
      z[i] = (static_cast<float>(static_cast<int32_t>(sum)) * 0x1p-16f - 2) * 1.7320508f;
      streams->state[i] = s * streams->leap + streams->add;
    }
    const int n = pixels - first < kPixels ? pixels - first : kPixels;
    for (int i = 0; i < n; ++i) {
      const float shared = z[4 * i];
      for (int c = 0; c < 3; ++c) {
        float& value = rgb[3 * (first + i) + c];
        const float noise = shared * shared_share + z[4 * i + 1 + c] * colored;
        value = within_one(value + sigma * noise * (1.2f - 0.8f * value));
      }
    }
  }
}

void PS_JOIN(part_, PS_ISA)(const float* rgb, float* __restrict luma, float* __restrict blue,
                            float* __restrict red, int pixels) {
  for (int i = 0; i < pixels; ++i) {
    const float r = rgb[3 * i], g = rgb[3 * i + 1], b = rgb[3 * i + 2];
    const float l = 0.299f * r + 0.587f * g + 0.114f * b;
    luma[i] = l;
    blue[i] = b - l;
    red[i] = r - l;
  }
}

void PS_JOIN(join_, PS_ISA)(const float* luma, const float* blue, const float* red,
                            float* __restrict rgb, int pixels) {
  for (int i = 0; i < pixels; ++i) {
    const float l = luma[i], b = blue[i] + l, r = red[i] + l;
    rgb[3 * i] = within_one(r);
    rgb[3 * i + 1] = within_one((l - 0.299f * r - 0.114f * b) / 0.587f);
    rgb[3 * i + 2] = within_one(b);
  }
}

void PS_JOIN(quantise_, PS_ISA)(float* block, int stride, const float* basis, const float* inverse,
                                const float* steps) {
  Eight rows[8], frequencies[8];
  for (int r = 0; r < 8; ++r) rows[r] = load_eight(block + r * stride);
  transform(rows, inverse, frequencies);
  constexpr float kWhole = 12582912;  // floats near it are whole numbers: rounds to the nearest
  for (int k = 0; k < 8; ++k) {
    const Eight step = load_eight(steps + 8 * k);
    frequencies[k] = ((frequencies[k] / step + kWhole) - kWhole) * step;
  }
  transform(frequencies, basis, rows);
  for (int r = 0; r < 8; ++r) {
    *reinterpret_cast<Eight*>(block + r * stride) = rows[r];
  }
}

}  // namespace effects_kernel
}  // namespace rooms
}  // namespace ps
