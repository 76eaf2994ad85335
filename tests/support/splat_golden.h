// SPDX-License-Identifier: BSD-3-Clause
// The published rasteriser's own numbers (SPEC.md 4), as excerpts that travel with the repository.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "io/safetensors.h"

namespace ps {

constexpr int kGoldenSide = 256;  ///< of the image, pixels
inline const std::string kGoldenFile = PS_DATA_DIR "/golden/splat.safetensors";

/// @return the numbers of a tensor of 32-bit integers
inline std::vector<std::int32_t> ints(const FileTensor& tensor) {
  std::vector<std::int32_t> values(tensor.elements());
  std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  return values;
}

/// What a rasteriser says of one pixel.
struct SplatPixel {
  cv::Vec3f color;
  bool background = false;
  std::int32_t count = 0;
  cv::Vec4i nearest;
};

/// @brief Compares pixels with the golden ones, which fill a window of the image.
/// @param view  which of them: "right" or "sway"
/// @param pixel_at  called with x and y, gives a SplatPixel
template <class PixelAt>
void expect_golden_splat(const std::string& view, const PixelAt& pixel_at) {
  constexpr int kWindow = 48;
  const TensorMap golden = read_safetensors(kGoldenFile);
  const auto tensor = [&](const char* name) { return golden.at(view + "." + name); };
  const auto corner = ints(tensor("corner")), count = ints(tensor("count"));
  const auto nearest = ints(tensor("idx4"));
  const auto image = tensor("image").as_floats(), background = tensor("bg_raw").as_floats();
  int counts_that_differ = 0;
  for (int i = 0; i < kWindow * kWindow; ++i) {
    const int x = corner[0] + i % kWindow, y = corner[1] + i / kWindow;
    const SplatPixel pixel = pixel_at(x, y);
    EXPECT_EQ(pixel.background, background[i] == 1) << x << " " << y;
    // A point within 1e-5 of the radius may fall on either side of it.
    EXPECT_LE(std::abs(pixel.count - count[i]), 1);
    counts_that_differ += pixel.count != count[i];
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(pixel.color[c], image[c * kWindow * kWindow + i], 2e-5);
    }
    for (int k = 0; k < 4; ++k) EXPECT_EQ(pixel.nearest[k], nearest[4 * i + k]);
  }
  EXPECT_LE(counts_that_differ, 2);
}

}  // namespace ps
