// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace ps {

/// @brief Random numbers that are a function of a key and a place: no state, so the same bytes
/// whatever the number of threads. Philox 4x32-10 of Salmon, Moraes, Dror and Shaw, "Parallel
/// Random Numbers: As Easy as 1, 2, 3" (2011).
/// @param key      the seed
/// @param counter  where in the stream: (view, completion, cell, purpose), say
/// @return four words of 32 random bits
std::array<std::uint32_t, 4> random_bits(std::uint64_t key,
                                         const std::array<std::uint32_t, 4>& counter);

/// @return a number in [0, 1), a multiple of 2^-53, from the first two words of random_bits
double random_unit(std::uint64_t key, const std::array<std::uint32_t, 4>& counter);

/// @return two numbers of N(0, 1), by Box and Muller, from random_bits
std::array<double, 2> random_normal(std::uint64_t key, const std::array<std::uint32_t, 4>& counter);

}  // namespace ps
