// SPDX-License-Identifier: BSD-3-Clause
// Every network, with weights by chance.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "libps/models/model_options.h"
#include "libps/nn/tensor.h"

namespace ps::bench {

struct Module {
  std::string name;
  double gflop = 0;      ///< of one forward, as SPEC.md 2 counts
  double target_ms = 0;  ///< of issue 3, where sgemm gives 189 GFLOP/s; 0 = none
  /// Makes the network; returns what runs it once and leaves its output in the tensor.
  std::function<std::function<void(nn::Workspace&)>(const models::ModelOptions&, nn::Tensor*)> make;
};

/// At the published widths.
std::vector<Module> modules();
/// At three widths each, the shipped one in the middle; `gflop` is not told.
std::vector<Module> modules_of_widths();

}  // namespace ps::bench
