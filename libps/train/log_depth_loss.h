// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: what a depth network is taught by, where depth is known.
#pragma once

#include <torch/torch.h>

namespace ps::train {

/// The mean over the examples of a batch; `sum` has gradients, the parts have none.
struct LogDepthLoss {
  torch::Tensor sum;       ///< value + gradient / 2
  torch::Tensor value;     ///< of |error - 0.7 mean|
  torch::Tensor gradient;  ///< of differences of errors
};

/// @brief Errors of the logarithm of depth. Scale is half a guess: most of a common factor is
/// forgiven. Differences of neighbours' errors, at four scales (Ranftl and others, MiDaS, TPAMI
/// 2022, equation 11), make edges where there are edges, and none where there are none. Of float on
/// the CPU value and gradients are our own loop: libtorch 1.13 takes 21 ms of a core for eight
/// pictures of 256x256, a tenth of a step. It has no second derivatives then.
/// @param log_depth  [n, 1, h, w], with gradients
/// @param log_truth  [n, 1, h, w]; counts where known alone
/// @param known      [n, 1, h, w], 1 where depth is known, else 0
/// Throws c10::Error when the shapes are others.
LogDepthLoss log_depth_loss(const torch::Tensor& log_depth, const torch::Tensor& log_truth,
                            const torch::Tensor& known);

/// @brief The same by libtorch's operators alone, on any device.
LogDepthLoss log_depth_loss_by_operators(const torch::Tensor& log_depth,
                                         const torch::Tensor& log_truth,
                                         const torch::Tensor& known);

/// @return [n], the mean over each example's pixels that the mask, ones and zeros, has
torch::Tensor masked_mean(const torch::Tensor& values, const torch::Tensor& mask);

}  // namespace ps::train
