// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/nn/convolution.h"

namespace ps::models {

/// @brief How a network computes; what it computes is in its weights.
///
/// What all networks of this room have in common: widths are read from the shapes of the weights;
/// tensors are channels last (libps/nn/tensor.h); `forward` takes its scratch from a Workspace that
/// the caller lends, so that networks that run one after another share one, and takes no other
/// memory once the workspace has grown, but for the closures of parallel loops; a network is not
/// changed by it, so threads may share a network if each has a workspace of its own. Constructors
/// throw ps::Error that names the tensor when the weights lack one or it has the wrong shape;
/// forwards throw ps::Error when a view's shape does not fit.
struct ModelOptions {
  nn::Method method = nn::Method::automatic;  ///< of convolutions
  nn::Storage storage = nn::Storage::f32;     ///< of weights
};

}  // namespace ps::models
