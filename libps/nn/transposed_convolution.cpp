// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/transposed_convolution.h"

#include "libps/core/error.h"
#include "libps/nn/indirect_product.h"

namespace ps::nn {
namespace {

/// Output 2y + phase takes, from input y + offset(phase, tap), the kernel's row kernel_row(phase,
/// tap).
int offset(int phase, int tap) { return tap - 1 + phase; }
int kernel_row(int phase, int tap) { return 3 - phase - 2 * tap; }

}  // namespace

TransposedConvolution::TransposedConvolution(const WeightTensor& weight, std::vector<float> bias,
                                             Storage storage)
    : bias_(std::move(bias)) {
  const auto& s = weight.shape;
  if (s.size() != 4 || s[2] != 4 || s[3] != 4 || weight.values.size() != weight.elements()) {
    throw Error("transposed convolution", "weights of shape " + to_string(s), "[in, out, 4, 4]");
  }
  check_bias(bias_, s[1], "transposed convolution");
  for (int phase = 0; phase < 4; ++phase) {
    matrices_[static_cast<std::size_t>(phase)] = PackedMatrix(
        4, static_cast<int>(s[0]), static_cast<int>(s[1]),
        [&](int tap, int row, int column) {
          const std::size_t kernel =
              static_cast<std::size_t>(row) * s[1] + static_cast<std::size_t>(column);
          const int at = kernel_row(phase / 2, tap / 2) * 4 + kernel_row(phase % 2, tap % 2);
          return weight.values[16 * kernel + static_cast<std::size_t>(at)];
        },
        storage);
  }
}

void TransposedConvolution::operator()(const TensorView& in, const TensorView& out,
                                       const Epilogue& given) const {
  const Shape& s = in.shape;
  check_same(s, {s.images, s.height, s.width, in_channels()}, "transposed convolution");
  check_same(out.shape, output(s), "transposed convolution");
  const Epilogue epilogue = with_bias(given, bias_, out.shape, "transposed convolution");
  const auto width = static_cast<std::size_t>(s.width);
  for (int phase = 0; phase < 4; ++phase) {
    const PackedMatrix& matrix = matrices_[static_cast<std::size_t>(phase)];
    IndirectRows rows;
    rows.count = s.pixels();
    rows.taps = 4;
    rows.sources = [&](std::size_t begin, std::size_t end, const float** pointers) {
      for (std::size_t row = begin; row < end; ++row) {
        const auto line = static_cast<int>(row / width), image = line / s.height;
        for (int tap = 0; tap < 4; ++tap) {
          const int y = line % s.height + offset(phase / 2, tap / 2);
          const int x = static_cast<int>(row % width) + offset(phase % 2, tap % 2);
          const bool inside = y >= 0 && y < s.height && x >= 0 && x < s.width;
          pointers[slot_of(row - begin, tap, 4)] = inside ? in.pixel(image, y, x) : nullptr;
        }
      }
    };
    rows.target = [&](std::size_t row) {  // lines of `in` become every other line of `out`
      return (2 * (row / width) + static_cast<std::size_t>(phase / 2)) * 2 * width +
             2 * (row % width) + static_cast<std::size_t>(phase % 2);
    };
    indirect_product(matrix, rows, out, epilogue);
  }
}

}  // namespace ps::nn
