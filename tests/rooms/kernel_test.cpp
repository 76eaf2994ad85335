// SPDX-License-Identifier: BSD-3-Clause
// Every build of a kernel that this machine can run, against the obvious way: the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "libps/rooms/dice.h"
#include "libps/rooms/effects_kernel.h"
#include "libps/rooms/light_kernel.h"
#include "libps/rooms/plane_kernel.h"
#include "libps/rooms/tree.h"

namespace ps::rooms {
namespace {

#if defined(__x86_64__)
#define PS_BUILDS(name) builds_of(name##_baseline, name##_avx2, name##_avx512)
#else
#define PS_BUILDS(name) builds_of(name##_baseline, name##_baseline, name##_baseline)
#endif

template <typename F>
std::vector<F*> builds_of(F* baseline, [[maybe_unused]] F* avx2, [[maybe_unused]] F* avx512) {
  std::vector<F*> builds = {baseline};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) builds.push_back(avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    builds.push_back(avx512);
  }
#endif
  return builds;
}

std::vector<float> random_floats(Dice& d, int count, float low, float high) {
  std::vector<float> all(count);
  for (float& x : all) x = d.range(low, high);
  return all;
}

TEST(Kernels, of_planes_give_the_same_bytes_in_every_build) {
  Dice d(2, 1);
  constexpr int kCount = 48;
  std::vector<float> values[15];
  std::vector<std::int32_t> surfaces[5];
  plane_kernel::Stretch taps[5];
  for (int t = 0; t < 5; ++t) {
    for (int i = 0; i < kCount; ++i) surfaces[t].push_back(d.below(2));
    for (int c = 0; c < 3; ++c) {
      values[3 * t + c] = random_floats(d, kCount, 0, 3);
      taps[t].value[c] = values[3 * t + c].data();
    }
    taps[t].surface = surfaces[t].data();
  }
  const auto run = [&](auto* kernel) {
    std::vector<float> out(3 * kCount);
    float* const planes[3] = {&out[0], &out[kCount], &out[2 * kCount]};
    kernel(taps, planes, kCount);
    return out;
  };
  for (auto* kernel : PS_BUILDS(plane_kernel::share)) {
    EXPECT_EQ(run(kernel), run(plane_kernel::share_baseline));
  }
  for (auto* kernel : PS_BUILDS(plane_kernel::share_alike)) {
    EXPECT_EQ(run(kernel), run(plane_kernel::share_alike_baseline));
  }
  const std::vector<float> table = random_floats(d, 33, 0, 1), in = random_floats(d, 75, -1, 5);
  for (const bool root : {false, true}) {
    const plane_kernel::Curve curve = {table.data(), 32, 4, root};
    std::vector<float> wanted;
    for (const float x : in) {
      const float share = std::clamp(x / 4, 0.f, 0.9999f);
      const float at = (root ? std::sqrt(share) : share) * 32;
      const int k = static_cast<int>(at);
      wanted.push_back(mix(table[k], table[k + 1], at - static_cast<float>(k)));
    }
    for (auto* kernel : PS_BUILDS(plane_kernel::look)) {
      std::vector<float> out = in;
      kernel(curve, out.data(), out.data(), static_cast<int>(out.size()));
      EXPECT_EQ(out, wanted);
    }
  }
}

TEST(Kernels, of_effects_tint_and_weigh_as_said) {
  Dice d(3, 1);
  constexpr int kPixels = 37;
  const std::vector<float> rgb = random_floats(d, 3 * kPixels, 0, 1),
                           light = random_floats(d, kPixels, 0.5f, 1.2f);
  const float gains[3] = {1.1f, 1, 0.8f};
  std::vector<float> tinted, weighed;
  for (int i = 0; i < kPixels; ++i) {
    float v[3];
    for (int c = 0; c < 3; ++c) v[c] = std::min(1.f, rgb[3 * i + c] * gains[c] * light[i]);
    const float grey = 0.3f * v[0] + 0.59f * v[1] + 0.11f * v[2];
    for (const float x : v) tinted.push_back(clamp01(grey + (x - grey) * 1.3f));
  }
  for (auto* kernel : PS_BUILDS(effects_kernel::tint)) {
    std::vector<float> out = rgb;
    kernel(out.data(), light.data(), gains, 1.3f, kPixels);
    EXPECT_EQ(out, tinted);
  }
  const float* const taps[3] = {&rgb[0], &rgb[1], &rgb[7]};
  const float weights[3] = {0.3f, 0.5f, 0.1f};
  for (int i = 0; i < 100; ++i) {
    float sum = 0;
    for (int t = 0; t < 3; ++t) sum += weights[t] * taps[t][i];
    weighed.push_back(sum / 0.9f);
  }
  for (auto* kernel : PS_BUILDS(effects_kernel::weigh)) {
    std::vector<float> out(100);
    kernel(taps, weights, 3, 0.9f, out.data(), 100);
    EXPECT_EQ(out, weighed);
  }
}

TEST(Kernels, of_grain_draw_one_number_after_another) {
  constexpr std::uint64_t kTimes = 6364136223846793005u, kPlus = 1442695040888963407u;
  constexpr int kPixels = 23;
  const std::vector<float> rgb(3 * kPixels, 0.5f);
  std::vector<float> wanted = rgb;
  effects_kernel::Streams streams{{}, 1, 0};
  std::uint64_t state = 77;
  for (std::uint64_t& s : streams.state) {
    s = state = state * kTimes + kPlus;
    streams.leap *= kTimes;
    streams.add = streams.add * kTimes + kPlus;
  }
  state = 77;
  const auto normal = [&] {
    state = state * kTimes + kPlus;
    const std::uint64_t x = state ^ state >> 29;
    float sum = 0;
    for (const int shift : {0, 16, 32, 48}) sum += static_cast<float>(x >> shift & 0xffff);
    return (sum * 0x1p-16f - 2) * 1.7320508f;
  };
  for (int i = 0; i < kPixels; ++i) {
    const float shared = normal();
    for (int c = 0; c < 3; ++c) {
      float& value = wanted[3 * i + c];
      value = clamp01(value + 0.05f * mix(shared, normal(), 0.4f) * (1.2f - 0.8f * value));
    }
  }
  for (auto* kernel : PS_BUILDS(effects_kernel::grain)) {
    effects_kernel::Streams own = streams;
    std::vector<float> out = rgb;
    kernel(&own, out.data(), 0.05f, 0.4f, kPixels);
    EXPECT_EQ(out, wanted);
  }
}

TEST(Kernels, of_blocks_quantise_the_cosine_transform) {
  Dice d(4, 1);
  constexpr int kStride = 11;
  float basis[64], inverse[64], steps[64];
  for (int k = 0; k < 8; ++k) {
    for (int i = 0; i < 8; ++i) {
      basis[8 * k + i] = inverse[8 * i + k] = static_cast<float>(
          (k == 0 ? std::sqrt(0.125) : 0.5) * std::cos((2 * i + 1) * k * M_PI / 16));
      steps[8 * k + i] = 0.01f + 0.005f * static_cast<float>(k + i);
    }
  }
  const std::vector<float> block = random_floats(d, 8 * kStride, 0, 1);
  const auto transform = [&](const std::vector<double>& in, bool back) {
    std::vector<double> out(64);
    for (int v = 0; v < 8; ++v) {
      for (int u = 0; u < 8; ++u) {
        for (int y = 0; y < 8; ++y) {
          for (int x = 0; x < 8; ++x) {
            const float* m = back ? inverse : basis;
            out[8 * v + u] += in[8 * y + x] * m[8 * v + y] * m[8 * u + x];
          }
        }
      }
    }
    return out;
  };
  std::vector<double> wanted;
  for (int i = 0; i < 64; ++i) wanted.push_back(block[i / 8 * kStride + i % 8]);
  wanted = transform(wanted, false);
  for (int i = 0; i < 64; ++i) wanted[i] = std::nearbyint(wanted[i] / steps[i]) * steps[i];
  wanted = transform(wanted, true);
  std::vector<float> baseline = block;
  effects_kernel::quantise_baseline(baseline.data(), kStride, basis, inverse, steps);
  for (auto* kernel : PS_BUILDS(effects_kernel::quantise)) {
    std::vector<float> out = block;
    kernel(out.data(), kStride, basis, inverse, steps);
    EXPECT_EQ(out, baseline);
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < kStride; ++x) {
        const std::size_t i = y * kStride + x;
        EXPECT_NEAR(out[i], x < 8 ? wanted[8 * y + x] : block[i], 1e-5);
      }
    }
  }
}

TEST(Kernels, of_luma_come_back_to_the_colours_they_were) {
  Dice d(5, 1);
  const std::vector<float> rgb = random_floats(d, 3 * 21, 0, 1);
  for (auto* part : PS_BUILDS(effects_kernel::part)) {
    std::vector<float> luma(21), blue(21), red(21);
    part(rgb.data(), luma.data(), blue.data(), red.data(), 21);
    std::vector<float> first;
    for (auto* join : PS_BUILDS(effects_kernel::join)) {
      std::vector<float> out(rgb.size());
      join(luma.data(), blue.data(), red.data(), out.data(), 21);
      for (std::size_t i = 0; i < rgb.size(); ++i) EXPECT_NEAR(out[i], rgb[i], 1e-6);
      if (first.empty()) first = out;
      EXPECT_EQ(out, first);
    }
  }
}

TEST(Kernels, of_lamps_sum_the_rates_of_each) {
  Dice d(6, 1);
  light_kernel::Places places;
  for (int i = 0; i < kRays; ++i) {
    places.x[i] = d.range(-2, 2);
    places.y[i] = d.range(0, 2);
    places.z[i] = d.range(-2, 2);
    places.nx[i] = places.nz[i] = 0;
    places.ny[i] = d.sign();
  }
  const light_kernel::Lamp lamps[2] = {{{0, 2.5f, 0}, {0, -1, 0}, 0.3f, 0.4f, 0},
                                       {{1, 1, 0}, {0, 1, 0}, 0.1f, 0.1f, 1}};
  float baseline[2][kRays], all[kRays], total[kRays];
  light_kernel::weigh_baseline(lamps, 2, places, 3, baseline, all, total);
  for (auto* kernel : PS_BUILDS(light_kernel::weigh)) {
    float rates[2][kRays];
    kernel(lamps, 2, places, 3, rates, all, total);
    for (int i = 0; i < kRays; ++i) {
      EXPECT_EQ(rates[0][i], baseline[0][i]);
      EXPECT_EQ(rates[1][i], baseline[1][i]);
      EXPECT_EQ(all[i], rates[0][i] + rates[1][i]);
      EXPECT_FLOAT_EQ(total[i], 3 * all[i]);
      // The ceiling lamp sends nothing to what looks down from well below it.
      if (places.ny[i] < 0 && places.y[i] < 2) {
        EXPECT_EQ(rates[0][i], 0);
      }
    }
  }
}

TEST(Kernels, that_enter_a_frame_give_rays_that_meet_the_same_points) {
  Dice d(7, 1);
  Rays rays;
  clear(rays);
  for (int i = 0; i < kRays; i += 2) {
    set_ray(rays, i, {d.range(-1, 1), d.range(-1, 1), d.range(-1, 1)}, {d.unit(), -d.unit(), 0}, 5);
  }
  const Frame f = turned(0.7f, {1, 2, 3});
  const trace_kernel::Axes axes = {
      {{2 * f.ex.x, 2 * f.ex.y, 2 * f.ex.z}, {0, 1, 0}, {f.ez.x, f.ez.y, f.ez.z}},
      {4 * dot(f.ex, f.ex), 1, dot(f.ez, f.ez)},
      {1, 2, 3}};
  Rays baseline;
  trace_kernel::enter_baseline(axes, rays, baseline);
  for (auto* kernel : PS_BUILDS(trace_kernel::enter)) {
    Rays local;
    kernel(axes, rays, local);
    EXPECT_EQ(std::memcmp(&local, &baseline, sizeof local), 0);
    for (int i = 0; i < kRays; ++i) {
      ASSERT_EQ(local.reach[i], i % 2 == 0 ? 5 : -1);
      if (i % 2 != 0) continue;
      const auto at = [i](const Rays& r) {
        return Vec{r.origin[0][i] + 3 * r.direction[0][i], r.origin[1][i] + 3 * r.direction[1][i],
                   r.origin[2][i] + 3 * r.direction[2][i]};
      };
      const Vec q = at(local);
      const Vec back = f.ex * (2 * q.x) + f.ey * q.y + f.ez * q.z + f.origin;
      EXPECT_NEAR(length(back - at(rays)), 0, 1e-5);
    }
  }
}

}  // namespace
}  // namespace ps::rooms
