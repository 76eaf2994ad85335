// SPDX-License-Identifier: BSD-3-Clause
#include "tests/models/support.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "io/weights_file.h"

namespace ps::models {

void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }

bool is_exact(const Setting& setting) { return setting.options.storage == nn::Storage::f32; }

std::vector<Setting> all_settings() {
  return {{"direct", {nn::Method::direct, nn::Storage::f32}},
          {"winograd", {nn::Method::winograd, nn::Storage::f32}},
          {"bf16", {nn::Method::automatic, nn::Storage::bf16}}};
}

std::string name_of(const testing::TestParamInfo<Setting>& info) { return info.param.name; }

const nn::Weights& reference_weights() {
  static const nn::Weights weights = read_weights(shared("reference/weights.safetensors"));
  return weights;
}

const nn::Weights& golden_weights() {
  static const nn::Weights weights = read_weights(PS_DATA_DIR "/golden/weights.safetensors");
  return weights;
}

const TensorMap& goldens() {
  static const TensorMap tensors = read_safetensors(PS_DATA_DIR "/golden/networks.safetensors");
  return tensors;
}

nn::Tensor golden_picture() {
  constexpr int kSide = 256;
  nn::Tensor tensor({1, kSide, kSide, 3});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int value = (2 * x + 3 * y * (c + 1) + 50 * ((x / 24 + y / 40) % 3)) % 256;
        tensor.view().pixel(0, y, x)[c] = static_cast<float>(value / 127.5 - 1);
      }
    }
  }
  return tensor;
}

std::vector<std::uint8_t> golden_background() {
  const std::vector<std::uint8_t> packed = bytes_of(goldens().at("order.bg256"));
  std::vector<std::uint8_t> background;
  for (std::size_t i = 0; i < 8 * packed.size(); ++i)
    background.push_back(packed[i / 8] >> i % 8 & 1);
  return background;
}

nn::Tensor golden_corner() {
  nn::Tensor corner = tensor_of(goldens().at("corner"));
  for (std::size_t i = 0; i < corner.shape().pixels() * 3; ++i) {
    corner.data()[i] = static_cast<float>(corner.data()[i] / 127.5 - 1);
  }
  return corner;
}

nn::Tensor corner_of(const nn::TensorView& view, int side) {
  nn::Shape shape = view.shape;
  shape.height = shape.width = side;
  nn::Tensor corner(shape);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      std::copy_n(view.pixel(0, view.shape.height - side + y, view.shape.width - side + x),
                  shape.channels, corner.view().pixel(0, y, x));
    }
  }
  return corner;
}

nn::Tensor tensor_of(const FileTensor& planes) {
  const auto axis = [&](std::size_t i) { return static_cast<int>(planes.shape.at(i)); };
  nn::Tensor tensor({axis(0), axis(2), axis(3), axis(1)});
  nn::from_planes(planes.as_floats().data(), tensor);
  return tensor;
}

std::vector<std::int32_t> ints_of(const FileTensor& tensor) {
  std::vector<std::int32_t> values(tensor.elements());
  std::memcpy(values.data(), tensor.bytes.data(), values.size() * sizeof(std::int32_t));
  return values;
}

std::vector<std::uint8_t> bytes_of(const FileTensor& tensor) {
  std::vector<std::uint8_t> values(tensor.elements());
  std::memcpy(values.data(), tensor.bytes.data(), values.size());
  return values;
}

nn::Tensor every(int step, const nn::TensorView& view) {
  nn::Shape shape = view.shape;
  shape.height = (shape.height + step - 1) / step;
  shape.width = (shape.width + step - 1) / step;
  nn::Tensor picked(shape);
  for (int n = 0; n < shape.images; ++n) {
    for (int y = 0; y < shape.height; ++y) {
      for (int x = 0; x < shape.width; ++x) {
        std::copy_n(view.pixel(n, y * step, x * step), shape.channels,
                    picked.view().pixel(n, y, x));
      }
    }
  }
  return picked;
}

Difference difference(const nn::TensorView& got, const nn::TensorView& expected) {
  EXPECT_TRUE(got.shape == expected.shape);
  Difference d;
  for (std::size_t i = 0; got.shape == expected.shape && i < got.shape.pixels(); ++i) {
    for (int c = 0; c < got.shape.channels; ++c) {
      const double wanted = expected.pixel(i)[c], off = std::abs(got.pixel(i)[c] - wanted);
      if (!(off <= d.worst)) d.worst = off;  // NaN too
      d.typical += off * off;
      d.largest = std::max(d.largest, std::abs(wanted));
    }
  }
  d.typical =
      std::sqrt(d.typical / static_cast<double>(expected.shape.pixels()) / expected.shape.channels);
  return d;
}

void expect_near(const std::string& what, const nn::TensorView& got, const nn::TensorView& expected,
                 double relative, double absolute) {
  const Difference d = difference(got, expected);
  std::printf("  %s: off by %.1e at most, %.1e rms; of the largest value %.3g: %.1e, %.1e\n",
              what.c_str(), d.worst, d.typical, d.largest, d.worst / d.largest,
              d.typical / d.largest);
  EXPECT_LE(d.worst, relative * d.largest) << what;
  EXPECT_LE(d.worst, absolute) << what;
}

}  // namespace ps::models
