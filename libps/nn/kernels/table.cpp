// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/kernels/table.h"

#include "libps/nn/kernels/elementwise.h"

namespace ps::nn {

const Kernels& PS_KERNEL(kernels)() {
  static const Kernels table = {
      kLanes,
      PS_KERNEL(most_vectors),
      PS_KERNEL(tile),
      PS_KERNEL(tile_bf16),
      PS_KERNEL(winograd_input),
      PS_KERNEL(winograd_output),
      PS_KERNEL(activate),
      PS_KERNEL(elu),
      PS_KERNEL(tanh),
      PS_KERNEL(sigmoid),
      PS_KERNEL(exp),
      PS_KERNEL(scale_shift),
      PS_KERNEL(add),
      PS_KERNEL(gated_add),
      PS_KERNEL(mix),
      PS_KERNEL(maximum),
  };
  return table;
}

}  // namespace ps::nn
