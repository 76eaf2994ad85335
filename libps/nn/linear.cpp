// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/linear.h"

#include "libps/core/error.h"
#include "libps/nn/indirect_product.h"

namespace ps::nn {

Linear::Linear(const WeightTensor& weight, std::vector<float> bias, Storage storage)
    : bias_(std::move(bias)) {
  if (weight.shape.size() != 2 || weight.values.size() != weight.elements()) {
    throw Error("linear layer", "weights of shape " + to_string(weight.shape), "[out, in]");
  }
  check_bias(bias_, weight.shape[0], "linear layer");
  const std::size_t in = weight.shape[1];
  matrix_ = PackedMatrix(
      1, static_cast<int>(in), static_cast<int>(weight.shape[0]),
      [&](int, int row, int column) {
        return weight.values[static_cast<std::size_t>(column) * in + static_cast<std::size_t>(row)];
      },
      storage);
}

void Linear::operator()(const TensorView& in, const TensorView& out, const Epilogue& given) const {
  const Shape& s = in.shape;
  check_same(s, {s.images, s.height, s.width, matrix_.depth()}, "linear layer");
  check_same(out.shape, {s.images, s.height, s.width, matrix_.columns()}, "linear layer");
  const Epilogue epilogue = with_bias(given, bias_, out.shape, "linear layer");
  IndirectRows rows;
  rows.count = s.pixels();
  rows.sources = [&](std::size_t begin, std::size_t end, const float** pointers) {
    for (std::size_t row = begin; row < end; ++row) pointers[row - begin] = in.pixel(row);
  };
  indirect_product(matrix_, rows, out, epilogue);
}

}  // namespace ps::nn
