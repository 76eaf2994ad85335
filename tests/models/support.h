// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the networks share: reference tensors, settings, comparisons that tell what
// they measured.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/safetensors.h"
#include "libps/models/model_options.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"
#include "tests/io/support.h"

namespace ps::models {

/// One way to compute.
struct Setting {
  const char* name;
  ModelOptions options;
};
void PrintTo(const Setting& setting, std::ostream* out);
bool is_exact(const Setting& setting);  ///< weights are kept as they are

/// direct, Winograd, and the default with weights in bf16
std::vector<Setting> all_settings();
std::string name_of(const testing::TestParamInfo<Setting>& info);

/// The published names and layouts, narrow: reference/weights.safetensors.
const nn::Weights& reference_weights();
/// The weights that the repository's own goldens were computed with.
const nn::Weights& golden_weights();
/// The goldens: data/golden/networks.safetensors.
const TensorMap& goldens();

/// A picture of formulas, RGB in [-1,1]: [1, 256, 256, 3]; the same as picture() in
/// make_goldens.py.
nn::Tensor golden_picture();
/// The bottom right corner of a photo, RGB in [-1,1]: [1, 96, 96, 3].
nn::Tensor golden_corner();

/// The goldens' background mask: 256x256, with an island of what is known amid what is missing.
std::vector<std::uint8_t> golden_background();

/// @param planes  [images, channels, height, width]
nn::Tensor tensor_of(const FileTensor& planes);
std::vector<std::int32_t> ints_of(const FileTensor& tensor);
std::vector<std::uint8_t> bytes_of(const FileTensor& tensor);

/// @return the bottom right corner of so many pixels a side
nn::Tensor corner_of(const nn::TensorView& view, int side);
/// @return every `step`-th pixel of both axes from the first on
nn::Tensor every(int step, const nn::TensorView& view);

struct Difference {
  double worst = 0;    ///< |difference|
  double typical = 0;  ///< root of the mean square difference
  double largest = 0;  ///< |expected|
};
Difference difference(const nn::TensorView& got, const nn::TensorView& expected);

/// @brief Compares, and prints what was measured.
/// @param relative  of the largest expected value   @param absolute  both bounds must hold
void expect_near(const std::string& what, const nn::TensorView& got, const nn::TensorView& expected,
                 double relative, double absolute = 1e30);

}  // namespace ps::models
