// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/masked_convolution.h"

#include "libps/core/error.h"
#include "libps/nn/indirect_product.h"

namespace ps::nn {

MaskedConvolution::MaskedConvolution(const WeightTensor& weight, std::vector<float> bias,
                                     int dilation, Storage storage)
    : bias_(std::move(bias)), dilation_(dilation) {
  const auto& s = weight.shape;
  if (s.size() != 4 || s[2] != 3 || s[3] != 3 || weight.values.size() != weight.elements()) {
    throw Error("masked convolution", "weights of shape " + to_string(s), "[out, in, 3, 3]");
  }
  if (dilation < 1) {
    throw Error("masked convolution", "dilation " + std::to_string(dilation), "at least 1");
  }
  check_bias(bias_, s[0], "masked convolution");
  matrix_ = PackedMatrix(
      9, static_cast<int>(s[1]), static_cast<int>(s[0]),
      [&](int tap, int row, int column) {
        const std::size_t kernel =
            static_cast<std::size_t>(column) * s[1] + static_cast<std::size_t>(row);
        return weight.values[9 * kernel + static_cast<std::size_t>(tap)];
      },
      storage);
}

void MaskedConvolution::operator()(const TensorView& in, const std::uint8_t* mask,
                                   const TensorView& out, const Epilogue& given) const {
  const Shape& s = in.shape;
  check_same(s, {s.images, s.height, s.width, matrix_.depth()}, "masked convolution");
  check_same(out.shape, {s.images, s.height, s.width, matrix_.columns()}, "masked convolution");
  const Epilogue epilogue = with_bias(given, bias_, out.shape, "masked convolution");
  const auto width = static_cast<std::size_t>(s.width), height = static_cast<std::size_t>(s.height);
  const std::size_t cells = width * height;
  IndirectRows rows;
  rows.count = s.pixels();
  rows.taps = 9;
  rows.sources = [&](std::size_t begin, std::size_t end, const float** pointers) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::size_t cell = row % cells;
      for (int tap = 0; tap < 9; ++tap) {
        const int y = static_cast<int>(cell / width) + (tap / 3 - 1) * dilation_;
        const int x = static_cast<int>(cell % width) + (tap % 3 - 1) * dilation_;
        const bool inside = y >= 0 && y < s.height && x >= 0 && x < s.width;
        const bool visible = inside && mask[static_cast<std::size_t>(tap) * cells + cell];
        pointers[slot_of(row - begin, tap, 9)] =
            visible ? in.pixel(static_cast<int>(row / cells), y, x) : nullptr;
      }
    }
  };
  indirect_product(matrix_, rows, out, epilogue);
}

}  // namespace ps::nn
