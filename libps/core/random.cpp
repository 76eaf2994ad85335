// SPDX-License-Identifier: BSD-3-Clause
#include "libps/core/random.h"

#include <cmath>

namespace ps {
namespace {

constexpr int kRounds = 10;
constexpr std::uint32_t kMultiplier0 = 0xD2511F53, kMultiplier1 = 0xCD9E8D57;
constexpr std::uint32_t kStep0 = 0x9E3779B9, kStep1 = 0xBB67AE85;  ///< of the key

double unit(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = static_cast<std::uint64_t>(high) << 32 | low;
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace

std::array<std::uint32_t, 4> random_bits(std::uint64_t key,
                                         const std::array<std::uint32_t, 4>& counter) {
  std::array<std::uint32_t, 4> c = counter;
  auto k0 = static_cast<std::uint32_t>(key), k1 = static_cast<std::uint32_t>(key >> 32);
  for (int round = 0; round < kRounds; ++round, k0 += kStep0, k1 += kStep1) {
    const std::uint64_t p0 = static_cast<std::uint64_t>(kMultiplier0) * c[0];
    const std::uint64_t p1 = static_cast<std::uint64_t>(kMultiplier1) * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k0, static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k1, static_cast<std::uint32_t>(p0)};
  }
  return c;
}

double random_unit(std::uint64_t key, const std::array<std::uint32_t, 4>& counter) {
  const auto bits = random_bits(key, counter);
  return unit(bits[0], bits[1]);
}

std::array<double, 2> random_normal(std::uint64_t key,
                                    const std::array<std::uint32_t, 4>& counter) {
  const auto bits = random_bits(key, counter);
  const double radius = std::sqrt(-2 * std::log(1 - unit(bits[0], bits[1])));
  const double angle = 2 * M_PI * unit(bits[2], bits[3]);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace ps
