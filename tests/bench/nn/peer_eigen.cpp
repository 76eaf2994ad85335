// SPDX-License-Identifier: BSD-3-Clause
// Compiled for this machine's own instruction set.
#include <Eigen/Core>

#include "tests/bench/nn/peers.h"

namespace ps::bench {

Peak peak_of_eigen() {
  constexpr int kSize = 2048;
  const Eigen::MatrixXf a = Eigen::MatrixXf::Constant(kSize, kSize, 0.5f), b = a;
  Eigen::MatrixXf c(kSize, kSize);
  const double seconds = fastest(5, [&] { c.noalias() = a * b; });
  return {"Eigen", 2.0 * kSize * kSize * kSize / seconds * 1e-9};
}

}  // namespace ps::bench
