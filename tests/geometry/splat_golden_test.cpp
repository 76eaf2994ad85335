// SPDX-License-Identifier: BSD-3-Clause
// The published rasteriser's own numbers (SPEC.md 4), as excerpts that travel with the repository.
#include <gtest/gtest.h>

#include <cstring>

#include "io/safetensors.h"
#include "libps/geometry/splat.h"

namespace ps {
namespace {

constexpr int kImage = 256;
constexpr int kWindow = 48;

std::vector<std::int32_t> ints(const FileTensor& tensor) {
  std::vector<std::int32_t> values(tensor.elements());
  std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  return values;
}

/// The rasteriser's plane: x left, y up, pixel i's centre at -1 + (2i + 1) / 256 from the other
/// side.
PlanePoints plane_points(const std::vector<float>& points, const std::vector<float>& features) {
  const std::size_t count = points.size() / 3;
  PlanePoints plane;
  for (std::size_t i = 0; i < count; ++i) {
    plane.u.push_back(static_cast<float>((1.0 - points[3 * i]) * kImage / 2 - 0.5));
    plane.v.push_back(static_cast<float>((1.0 - points[3 * i + 1]) * kImage / 2 - 0.5));
    plane.z.push_back(points[3 * i + 2]);
    plane.color.emplace_back(features[i], features[count + i], features[2 * count + i]);
  }
  return plane;
}

class SplatGolden : public testing::TestWithParam<const char*> {};

TEST_P(SplatGolden, equals_the_published_rasteriser) {
  const TensorMap golden = read_safetensors(PS_DATA_DIR "/golden/splat.safetensors");
  const auto tensor = [&](const std::string& name) { return golden.at(GetParam() + name); };
  SplatOptions options;
  options.near = 0;
  options.count_hits = true;
  const Splat out =
      splat_plane(plane_points(tensor(".points").as_floats(), tensor(".features").as_floats()),
                  {kImage, kImage}, options);
  const auto corner = ints(tensor(".corner")), count = ints(tensor(".count")),
             nearest = ints(tensor(".idx4"));
  const auto image = tensor(".image").as_floats(), background = tensor(".bg_raw").as_floats();
  int counts_that_differ = 0;
  for (int i = 0; i < kWindow * kWindow; ++i) {
    const int x = corner[0] + i % kWindow, y = corner[1] + i / kWindow;
    EXPECT_EQ(out.hit(y, x) == 0, background[i] == 1) << x << " " << y;
    // A point within 1e-5 of the radius may fall on either side of it.
    EXPECT_LE(std::abs(out.count(y, x) - count[i]), 1);
    counts_that_differ += out.count(y, x) != count[i];
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(out.color(y, x)[c], image[c * kWindow * kWindow + i], 2e-5);
    }
    for (int k = 0; k < 4; ++k) EXPECT_EQ(out.nearest(y, x)[k], nearest[4 * i + k]);
  }
  EXPECT_LE(counts_that_differ, 2);
}

INSTANTIATE_TEST_SUITE_P(views, SplatGolden, testing::Values("right", "sway"));

}  // namespace
}  // namespace ps
