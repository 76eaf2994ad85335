// SPDX-License-Identifier: BSD-3-Clause
// PCL's own z-buffer: a planar range image. It keeps depth alone, no colour, and a point reaches no
// further than the four pixels round it; one thread.
#include <benchmark/benchmark.h>
#include <pcl/range_image/range_image_planar.h>

#include <cmath>

#include "splat_case.h"

namespace ps::bench {
namespace {

void pcl_range_image_planar(benchmark::State& state) {
  const SplatCase& given = splat_case(state);
  const Intrinsics& k = given.intrinsics;
  const Eigen::Affine3f pose(given.world_from_cam.cast<float>().matrix());
  pcl::RangeImagePlanar image;
  for (auto _ : state) {
    image.createFromPointCloudWithFixedSize(
        *given.cloud, k.width, k.height, static_cast<float>(k.cx), static_cast<float>(k.cy),
        static_cast<float>(k.fx), static_cast<float>(k.fy), pose, pcl::RangeImage::CAMERA_FRAME);
    benchmark::DoNotOptimize(image.data());
  }
  double covered = 0;
  for (const pcl::PointWithRange& pixel : image) covered += std::isfinite(pixel.range) ? 1 : 0;
  report(state, given, covered);
}
BENCHMARK(pcl_range_image_planar)->Apply(peer_cases);

}  // namespace
}  // namespace ps::bench
