// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: a step of Adam in one pass over memory.
#pragma once

#include <torch/torch.h>

namespace ps::train {

/// What one step does to every value: first and second are moved towards the gradient and its
/// square, the value by -rate * first / (sqrt(second * correction) + eps), the average to it.
struct AdamRates {
  float gradient = 1;  ///< what gradients are multiplied by
  float beta1 = 0, beta2 = 0;
  float shrink = 1;  ///< what the value is multiplied by before it is moved
  float rate = 0;
  float correction = 1;  ///< of second, which begins at 0
  float eps = 0;
  float to_average = 0;  ///< how far the average goes towards the value
};

/// @brief Moves value, first, second and average, all of one shape. Of dense floats on the CPU it
/// is our own loop, each value by itself, so that the number of threads makes no difference.
void move_along(const torch::Tensor& gradient, const torch::Tensor& value,
                const torch::Tensor& first, const torch::Tensor& second,
                const torch::Tensor& average, const AdamRates& rates);
/// @brief The same by libtorch's operators alone, on any device. Both throw c10::Error as torch
/// does.
void move_along_by_operators(const torch::Tensor& gradient, const torch::Tensor& value,
                             const torch::Tensor& first, const torch::Tensor& second,
                             const torch::Tensor& average, const AdamRates& rates);

/// @return the sum of squares, whatever the number of threads; of dense floats on the CPU by our
/// own loop, in float over 16384 values and in double over those, else in double
double sum_of_squares(const torch::Tensor& x);

}  // namespace ps::train
