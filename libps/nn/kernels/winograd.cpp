// SPDX-License-Identifier: BSD-3-Clause
// F(4x4, 3x3): a 4x4 block of a 3x3 convolution from 36 products (Winograd 1980; Lavin and Gray
// 2016), by Toom and Cook's polynomials at 0, +-a, +-b and infinity.
#include "libps/nn/kernels/table.h"
#include "libps/nn/winograd_points.h"

namespace ps::nn {
namespace {

constexpr float kA = static_cast<float>(kWinogradA), kB = static_cast<float>(kWinogradB);
constexpr float kA2 = static_cast<float>(kWinogradA * kWinogradA);
constexpr float kB2 = static_cast<float>(kWinogradB * kWinogradB);
constexpr float kA3 = static_cast<float>(kWinogradA * kWinogradA * kWinogradA);
constexpr float kB3 = static_cast<float>(kWinogradB * kWinogradB * kWinogradB);
constexpr float kProduct = static_cast<float>(kWinogradA * kWinogradA * kWinogradB * kWinogradB);
constexpr float kSum = static_cast<float>(kWinogradA * kWinogradA + kWinogradB * kWinogradB);

/// Six values to six, `step` apart.
inline void transform_input(const Floats* d, int step, Floats* t, int t_step) {
  const Floats d0 = d[0], d1 = d[step], d2 = d[2 * step], d3 = d[3 * step], d4 = d[4 * step],
               d5 = d[5 * step];
  const Floats even_a = multiply_add(all(-kB2), d2, d4);
  const Floats odd_a = all(kA) * multiply_add(all(-kB2), d1, d3);
  const Floats even_b = multiply_add(all(-kA2), d2, d4);
  const Floats odd_b = all(kB) * multiply_add(all(-kA2), d1, d3);
  t[0] = multiply_add(all(kProduct), d0, multiply_add(all(-kSum), d2, d4));
  t[t_step] = even_a + odd_a;
  t[2 * t_step] = even_a - odd_a;
  t[3 * t_step] = even_b + odd_b;
  t[4 * t_step] = even_b - odd_b;
  t[5 * t_step] = multiply_add(all(kProduct), d1, multiply_add(all(-kSum), d3, d5));
}

/// Six values to four.
inline void transform_output(const Floats* m, int step, Floats* y, int y_step) {
  const Floats sum_a = m[step] + m[2 * step], difference_a = m[step] - m[2 * step];
  const Floats sum_b = m[3 * step] + m[4 * step], difference_b = m[3 * step] - m[4 * step];
  y[0] = m[0] + sum_a + sum_b;
  y[y_step] = multiply_add(all(kA), difference_a, all(kB) * difference_b);
  y[2 * y_step] = multiply_add(all(kA2), sum_a, all(kB2) * sum_b);
  y[3 * y_step] =
      multiply_add(all(kA3), difference_a, multiply_add(all(kB3), difference_b, m[5 * step]));
}

inline Floats read(const float* p, int count) {
  return count == kLanes ? load(p) : load_part(p, count);
}
inline void write(float* p, Floats v, int count) {
  if (count == kLanes) {
    store(p, v);
  } else {
    store_part(p, v, count);
  }
}

/// `count` channels from `channel` on, at most one vector.
inline void input_channels(const WinogradInput& job, int channel, int count) {
  Floats pixels[36], half[36];
  for (int i = 0; i < 36; ++i) {
    pixels[i] = Floats{};
    if (!job.pixels[i]) continue;
    pixels[i] = read(job.pixels[i] + channel, count);
    if (job.scale) {
      pixels[i] = multiply_add(pixels[i], read(job.scale + channel, count),
                               read(job.shift + channel, count));
      pixels[i] = activated(pixels[i], Floats{});
    }
  }
  for (int x = 0; x < 6; ++x) transform_input(pixels + x, 6, half + x, 6);
  for (int y = 0; y < 6; ++y) {
    Floats row[6];
    transform_input(half + 6 * y, 1, row, 1);
    float* out = job.out + static_cast<size_t>(6 * y) * job.step + channel;
    for (int x = 0; x < 6; ++x) write(out + static_cast<size_t>(x) * job.step, row[x], count);
  }
}

inline void output_channels(const WinogradOutput& job, int channel, int count) {
  Floats in[36], half[24];
  for (int i = 0; i < 36; ++i) {
    in[i] = read(job.in + static_cast<size_t>(i) * job.step + channel, count);
  }
  for (int x = 0; x < 6; ++x) transform_output(in + x, 6, half + x, 6);
  for (int y = 0; y < 4; ++y) {
    Floats row[4];
    transform_output(half + 6 * y, 1, row, 1);
    for (int x = 0; x < 4; ++x) {
      if (!job.out[4 * y + x]) continue;
      Floats v = row[x];
      if (job.bias) v += read(job.bias + channel, count);
      if (job.scale) {
        v = multiply_add(v, read(job.scale + channel, count), read(job.shift + channel, count));
      }
      if (job.residual) v += read(job.residual[4 * y + x] + channel, count);
      if (job.slope != 1.0f) v = activated(v, all(job.slope));
      write(job.out[4 * y + x] + channel, v, count);
    }
  }
}

}  // namespace

void PS_KERNEL(winograd_input)(const WinogradInput& job) {
  int channel = 0;
  for (; channel + kLanes <= job.channels; channel += kLanes) input_channels(job, channel, kLanes);
  if (channel < job.channels) input_channels(job, channel, job.channels - channel);
}

void PS_KERNEL(winograd_output)(const WinogradOutput& job) {
  int channel = 0;
  for (; channel + kLanes <= job.channels; channel += kLanes) output_channels(job, channel, kLanes);
  if (channel < job.channels) output_channels(job, channel, job.channels - channel);
}

}  // namespace ps::nn
