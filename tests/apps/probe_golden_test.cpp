// SPDX-License-Identifier: BSD-3-Clause
// `pixelsynth probe splat` gives the published rasteriser's own numbers (SPEC.md 4).
#include <cstdlib>

#include "tests/io/support.h"
#include "tests/support/splat_golden.h"

namespace ps::apps {
namespace {

TEST(ProbeSplat, equals_the_published_rasteriser) {
  const Folder folder;
  const std::string out = folder / "out.safetensors";
  const std::string command = "'" PS_PROGRAM "' -q probe splat --in '" + kGoldenFile +
                              "' --prefix right. --out '" + out + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;

  constexpr std::size_t kSide = kGoldenSide;
  const TensorMap probed = read_safetensors(out);
  ASSERT_EQ(probed.at("image").shape, (std::vector<std::size_t>{1, 3, kSide, kSide}));
  ASSERT_EQ(probed.at("bg_raw").shape, (std::vector<std::size_t>{1, kSide, kSide}));
  ASSERT_EQ(probed.at("count").shape, (std::vector<std::size_t>{1, kSide, kSide}));
  ASSERT_EQ(probed.at("idx4").shape, (std::vector<std::size_t>{1, kSide, kSide, 4}));
  const auto image = probed.at("image").as_floats(), background = probed.at("bg_raw").as_floats();
  const auto count = ints(probed.at("count")), nearest = ints(probed.at("idx4"));
  expect_golden_splat("right", [&](int x, int y) {
    const std::size_t at = static_cast<std::size_t>(y) * kSide + x, plane = kSide * kSide;
    return SplatPixel{{image[at], image[plane + at], image[2 * plane + at]},
                      background[at] == 1,
                      count[at],
                      cv::Vec4i(&nearest[4 * at])};
  });
}

}  // namespace
}  // namespace ps::apps
