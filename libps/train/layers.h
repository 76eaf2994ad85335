// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: layers of networks in training. Each has a function that makes its tensors
// in a Parameters, and one that computes.
#pragma once

#include <string>

#include "libps/train/parameters.h"

namespace ps::train {

/// @param gain  of the size of signals; 1 keeps it where ReLU cuts off half of them (He and others,
/// ICCV 2015)
void add_convolution(Parameters& p, const std::string& name, int in, int out, int kernel,
                     double gain = 1, bool bias = true);
void add_transposed(Parameters& p, const std::string& name, int in, int out, double gain = 1);
void add_batch_norm(Parameters& p, const std::string& name, int channels);
/// @brief A linear layer with weight norm: `.weight_v`, `.weight_g`, `.bias`.
void add_normed(Parameters& p, const std::string& name, int in, int out);

/// @brief While there is one, the products of this thread's convolutions are of bfloat16 values and
/// summed in float (Kalamkar and others, A Study of BFLOAT16 for Deep Learning Training, 2019):
/// a depth network trains 3.5 times as fast where the processor has AMX. Weights, sums and
/// losses stay float; activations between products are bfloat16, too, where normed_convolution(),
/// relu_upsample_2x() and elu_taps() make them.
class NarrowProducts {
 public:
  explicit NarrowProducts(bool narrow);
  ~NarrowProducts();
  NarrowProducts(const NarrowProducts&) = delete;
  NarrowProducts& operator=(const NarrowProducts&) = delete;

 private:
  bool before_;
};

/// @return x as a factor of a product: bfloat16 where narrow ones are asked for
Tensor as_factor(const Tensor& x);
/// @brief torch::conv2d, with narrow products where they are asked for.
Tensor conv2d(const Tensor& x, const Tensor& weight, const Tensor& bias, int stride = 1,
              int padding = 0);
Tensor convolution(const Parameters& p, const std::string& name, const Tensor& x, int stride,
                   int padding);
/// @brief Of 4x4 taps at stride 2, padded by one; where products are narrow, as a 3x3 convolution
/// to four times the channels, as libtorch 1.13 has no narrow transposed one.
Tensor transposed(const Parameters& p, const std::string& name, const Tensor& x);
/// @brief By the batch in training, which also moves the running mean and variance; else by those.
Tensor batch_norm(const Parameters& p, const std::string& name, const Tensor& x, bool training);

}  // namespace ps::train
