// SPDX-License-Identifier: BSD-3-Clause
#include "splat_case.h"

#include "room_cloud.h"

namespace ps::bench {
namespace {

void name_arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"points", "size", "radius"})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime();
}

}  // namespace

const SplatCase& splat_case(const benchmark::State& state) {
  static Cloud cloud;
  static std::int64_t points = -1;
  static SplatCase given;
  if (state.range(0) != points) {
    points = state.range(0);
    cloud = Cloud();  // two of the largest need not be in memory at once
    cloud = room_cloud(static_cast<std::size_t>(points));
  }
  given.cloud = &cloud;
  given.intrinsics = room_camera(static_cast<int>(state.range(1)));
  given.world_from_cam = room_target();
  given.radius = static_cast<int>(state.range(2));
  return given;
}

void peer_cases(benchmark::internal::Benchmark* benchmark) {
  name_arguments(benchmark);
  benchmark->Args({131072, 256, 4})->Args({1000000, 1024, 4});
}

void scaling_cases(benchmark::internal::Benchmark* benchmark) {
  name_arguments(benchmark);
  for (const int points : {10000, 31623, 100000, 316228, 1000000, 3162278, 10000000}) {
    for (const int size : {256, 512, 1024, 2048}) {
      if (points == 1000000 && size == 1024) continue;  // comes with the radii
      benchmark->Args({points, size, 4});
    }
  }
  for (const int radius : {1, 2, 3, 4, 5, 6, 7, 8}) benchmark->Args({131072, 256, radius});
  for (const int radius : {1, 2, 3, 4, 5, 6, 7, 8}) benchmark->Args({1000000, 1024, radius});
}

void report(benchmark::State& state, const SplatCase& given, double covered_pixels) {
  const auto points = static_cast<double>(given.cloud->size());
  state.counters["cloud"] = points;
  state.counters["points_per_second"] =
      benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["covered"] = covered_pixels / (given.intrinsics.width * given.intrinsics.height);
}

}  // namespace ps::bench
