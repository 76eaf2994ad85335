// SPDX-License-Identifier: BSD-3-Clause
// All throw ps::Error when `out` has another shape than said. `out` must not overlap `in`.
#pragma once

#include "libps/nn/tensor.h"

namespace ps::nn {

/// @brief Twice the size, bilinear, align_corners = false (torch.nn.Upsample).
void upsample_bilinear_2x(const TensorView& in, const TensorView& out);

/// @return the shape of 3x3 pooling with stride 2 and padding 1
Shape half_size(const Shape& in);

/// @brief Average pooling 3x3, stride 2, padding 1; with `count_padding` the divisor is always 9,
/// else it is the number of pixels inside the image. out: half_size(in).
void average_pool(const TensorView& in, const TensorView& out, bool count_padding);

/// @brief Max pooling; pixels outside count as nothing. `ceil` as in torch: the last window may
/// begin inside the image and end outside.
struct MaxPool {
  int kernel = 3;
  int stride = 2;
  int padding = 0;
  bool ceil = false;
};
Shape pooled_size(const Shape& in, const MaxPool& pool);
void max_pool(const TensorView& in, const TensorView& out, const MaxPool& pool);

/// @brief The mean over each image's pixels. out: {images, 1, 1, channels}.
void global_average(const TensorView& in, const TensorView& out);

}  // namespace ps::nn
