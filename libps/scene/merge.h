// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: samples that speak for others.
#pragma once

#include <vector>

#include "libps/scene/sample_grid.h"

namespace ps {

/// @brief Thins samples: one after another, those of the least reach first, each that is left takes
/// those left within its reach, and speaks for them. None of longer reach takes one of the least.
/// (Poisson-disk sampling by dart throwing, Cook, ACM TOG 1986, with the samples as darts.)
/// @param grid   of cells of at least the greatest reach
/// @param reach  pixels, one for each sample; 0 takes none
/// @param meter  if given, told of samples, as parts of its stage
/// @return those that took themselves, in order
std::vector<Sample> merged(const std::vector<Sample>& samples, const SampleGrid& grid,
                           const std::vector<float>& reach, Meter* meter = nullptr);

}  // namespace ps
