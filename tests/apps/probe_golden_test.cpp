// SPDX-License-Identifier: BSD-3-Clause
// `pixelsynth probe splat` gives the published rasteriser's own numbers (SPEC.md 4).
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "io/safetensors.h"
#include "tests/io/support.h"

namespace ps::apps {
namespace {

constexpr int kImage = 256;
constexpr int kWindow = 48;

std::vector<std::int32_t> ints(const FileTensor& tensor) {
  std::vector<std::int32_t> values(tensor.elements());
  std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  return values;
}

TEST(ProbeSplat, equals_the_published_rasteriser) {
  const std::string file = PS_DATA_DIR "/golden/splat.safetensors";
  const Folder folder;
  const std::string out = folder / "out.safetensors";
  const std::string command =
      "'" PS_PROGRAM "' -q probe splat --in '" + file + "' --prefix right. --out '" + out + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;

  const TensorMap golden = read_safetensors(file), probed = read_safetensors(out);
  const auto corner = ints(golden.at("right.corner"));
  const auto image = golden.at("right.image").as_floats();
  const auto background = golden.at("right.bg_raw").as_floats();
  const auto nearest = ints(golden.at("right.idx4"));
  const auto probed_image = probed.at("image").as_floats();
  const auto probed_background = probed.at("bg_raw").as_floats();
  const auto probed_nearest = ints(probed.at("idx4"));
  ASSERT_EQ(probed.at("image").shape, (std::vector<std::size_t>{1, 3, kImage, kImage}));
  ASSERT_EQ(probed.at("bg_raw").shape, (std::vector<std::size_t>{1, kImage, kImage}));
  ASSERT_EQ(probed.at("idx4").shape, (std::vector<std::size_t>{1, kImage, kImage, 4}));
  for (int i = 0; i < kWindow * kWindow; ++i) {
    const int x = corner[0] + i % kWindow, y = corner[1] + i / kWindow, at = y * kImage + x;
    EXPECT_EQ(probed_background[at], background[i]) << x << " " << y;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(probed_image[c * kImage * kImage + at], image[c * kWindow * kWindow + i], 2e-5);
    }
    for (int k = 0; k < 4; ++k) EXPECT_EQ(probed_nearest[4 * at + k], nearest[4 * i + k]);
  }
}

}  // namespace
}  // namespace ps::apps
