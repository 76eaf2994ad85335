// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ps::nn {

/// The instruction sets that the operators are compiled for.
enum class Isa { baseline, avx2, avx512 };

/// @return those that this machine can run, slowest first
std::vector<Isa> available_isas();

/// @return the one in use: the fastest there is, unless chosen otherwise
Isa isa();

/// @brief Chooses one, for tests and measurements. Matrices stay with what they were packed for.
/// Throws ps::Error when this machine cannot run it.
void set_isa(Isa isa);

std::string to_string(Isa isa);

}  // namespace ps::nn
