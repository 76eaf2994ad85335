// SPDX-License-Identifier: BSD-3-Clause
// How long splatting takes, over points, image size and radius. The peers register themselves into
// the same program (bench_splat_vtk.cpp, bench_splat_pcl.cpp), so that ratios come from one run.
#include <benchmark/benchmark.h>

#include "libps/core/parallel.h"
#include "libps/geometry/splat.h"
#include "splat_case.h"

namespace ps::bench {
namespace {

void splat_room(benchmark::State& state) {
  const SplatCase& given = splat_case(state);
  SplatOptions options;
  options.radius = static_cast<float>(given.radius);
  Splat result;
  for (auto _ : state) {
    result = splat(*given.cloud, given.intrinsics, given.world_from_cam, options);
    benchmark::DoNotOptimize(result.color.data);
  }
  report(state, given, static_cast<double>(cv::countNonZero(result.hit)));
  state.counters["threads"] = threads();
}
BENCHMARK(splat_room)->Name("splat")->Apply(scaling_cases);

}  // namespace
}  // namespace ps::bench

BENCHMARK_MAIN();
