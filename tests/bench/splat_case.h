// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

#include "libps/geometry/camera.h"
#include "libps/geometry/point.h"

namespace ps::bench {

/// What one benchmark draws.
struct SplatCase {
  const Cloud* cloud = nullptr;
  Intrinsics intrinsics;
  Pose world_from_cam;
  int radius = 4;  ///< pixels
};

/// @return the case that the state's arguments (points, size, radius) name; its cloud is kept until
/// a case with another number of points is asked for
const SplatCase& splat_case(const benchmark::State& state);

/// Arguments at which the peers run; two of the scaling cases.
void peer_cases(benchmark::internal::Benchmark* benchmark);

/// 10 thousand to 10 million points, 256 to 2048 pixels, radius 1 to 8.
void scaling_cases(benchmark::internal::Benchmark* benchmark);

/// Counters: the points' true number, points a second, and the share of the pixels that were drawn
/// on.
void report(benchmark::State& state, const SplatCase& given, double covered_pixels);

}  // namespace ps::bench
