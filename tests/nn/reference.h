// SPDX-License-Identifier: BSD-3-Clause
// One slow and obvious version of every operator, in double precision, as a textbook writes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "libps/nn/resample.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"

namespace ps::nn::reference {

/// Values of a shape: channels last, dense.
struct Values {
  Values() = default;
  explicit Values(const Shape& s);
  /// What a view shows.
  explicit Values(const TensorView& view);

  double& at(int n, int y, int x, int c) { return values[index(n, y, x, c)]; }
  double at(int n, int y, int x, int c) const { return values[index(n, y, x, c)]; }
  /// 0 outside the image
  double padded(int n, int y, int x, int c) const;
  double largest() const;  ///< |value|; 0 of none

  Shape shape;
  std::vector<double> values;

 private:
  std::size_t index(int n, int y, int x, int c) const;
};

struct ConvolutionCase {
  int stride = 1, padding = 0, dilation = 1;
};

/// All of these: an empty bias is none.
Values convolution(const Values& in, const WeightTensor& weight, const std::vector<float>& bias,
                   const ConvolutionCase& options);
Values transposed_convolution(const Values& in, const WeightTensor& weight,
                              const std::vector<float>& bias);
Values masked_convolution(const Values& in, const std::vector<std::uint8_t>& mask,
                          const WeightTensor& weight, const std::vector<float>& bias, int dilation);
Values linear(const Values& in, const WeightTensor& weight, const std::vector<float>& bias);

/// For each value by itself, or for pairs of the same place.
Values map(const Values& in, const std::function<double(double)>& f);
Values map(const Values& a, const Values& b, const std::function<double(double, double)>& f);
Values activation(const Values& in, double slope);
Values scale_shift(const Values& in, const std::vector<float>& scale,
                   const std::vector<float>& shift);
double elu(double x);
double sigmoid(double x);
Values concat_elu(const Values& in);

Values instance_norm(const Values& in);
Values positional_norm(const Values& in);
Values softmax(const Values& in, double temperature);

Values upsample_bilinear_2x(const Values& in);
Values average_pool(const Values& in, bool count_padding);
Values max_pool(const Values& in, const MaxPool& pool);
Values global_average(const Values& in);

/// @param embed  [channels, codes]
std::vector<std::int32_t> nearest_codes(const Values& in, const WeightTensor& embed);

}  // namespace ps::nn::reference
