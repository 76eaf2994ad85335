// SPDX-License-Identifier: BSD-3-Clause
// What our operators are compared with; each file that implements these is built only where its
// library is.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>

namespace ps::bench {

struct ConvolutionCase {
  int side, in, out, kernel, stride, padding;

  int output() const { return (side + 2 * padding - kernel) / stride + 1; }
  double flops() const {  ///< of the direct algorithm: two for each multiplication
    return 2.0 * output() * output() * out * in * kernel * kernel;
  }
  std::string name() const {
    return std::to_string(in) + "->" + std::to_string(out) + " " + std::to_string(kernel) + "x" +
           std::to_string(kernel) + (stride > 1 ? " s" + std::to_string(stride) : "") + " at " +
           std::to_string(side) + "^2";
  }
};

/// @return seconds of the best of some runs; 0 = built without oneDNN
double time_onednn(const ConvolutionCase& c);

/// @return the name of the library and GFLOP/s of a 2048^3 product of matrices; 0 = built without
/// it
struct Peak {
  std::string name;
  double gflops = 0;
};
Peak peak_of_openblas();
Peak peak_of_eigen();

/// @return seconds of the fastest of `runs` runs, after one that is not counted
template <class Run>
double fastest(int runs, const Run& run) {
  run();
  double best = 1e30;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  return best;
}

}  // namespace ps::bench
