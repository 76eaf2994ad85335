// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/splat_golden.h"

#include "libps/geometry/splat.h"

namespace ps {
namespace {

/// The rasteriser's plane: x left, y up, pixel i's centre at -1 + (2i + 1) / 256 from the other
/// side.
PlanePoints plane_points(const std::vector<float>& points, const std::vector<float>& features) {
  const std::size_t count = points.size() / 3;
  PlanePoints plane;
  for (std::size_t i = 0; i < count; ++i) {
    plane.u.push_back(static_cast<float>((1.0 - points[3 * i]) * kGoldenSide / 2 - 0.5));
    plane.v.push_back(static_cast<float>((1.0 - points[3 * i + 1]) * kGoldenSide / 2 - 0.5));
    plane.z.push_back(points[3 * i + 2]);
    plane.color.emplace_back(features[i], features[count + i], features[2 * count + i]);
  }
  return plane;
}

class SplatGolden : public testing::TestWithParam<const char*> {};

TEST_P(SplatGolden, equals_the_published_rasteriser) {
  const std::string view = GetParam();
  const TensorMap golden = read_safetensors(kGoldenFile);
  const auto points = golden.at(view + ".points").as_floats();
  const auto features = golden.at(view + ".features").as_floats();
  SplatOptions options;
  options.near = 0;
  options.count_hits = true;
  const Splat out =
      splat_plane(plane_points(points, features), {kGoldenSide, kGoldenSide}, options);
  expect_golden_splat(view, [&](int x, int y) {
    return SplatPixel{out.color(y, x), out.hit(y, x) == 0, out.count(y, x), out.nearest(y, x)};
  });
}

INSTANTIATE_TEST_SUITE_P(views, SplatGolden, testing::Values("right", "sway"));

}  // namespace
}  // namespace ps
