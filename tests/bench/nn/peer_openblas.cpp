// SPDX-License-Identifier: BSD-3-Clause
#include <cblas.h>

#include <vector>

#include "tests/bench/nn/peers.h"

extern "C" char* openblas_get_corename();

namespace ps::bench {

Peak peak_of_openblas() {
  constexpr int kSize = 2048;
  const std::vector<float> a(kSize * kSize, 0.5f), b = a;
  std::vector<float> c(kSize * kSize);
  const double seconds = fastest(5, [&] {
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, kSize, kSize, kSize, 1, a.data(), kSize,
                b.data(), kSize, 0, c.data(), kSize);
  });
  return {std::string("OpenBLAS ") + openblas_get_corename(),
          2.0 * kSize * kSize * kSize / seconds * 1e-9};
}

}  // namespace ps::bench
