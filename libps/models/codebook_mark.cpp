// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/codebook_mark.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <sstream>

#include "libps/core/random.h"

namespace ps::models {
namespace {

constexpr std::size_t kSums = 8;
constexpr std::uint64_t kKey = 0x636f6465;  // of the signs; a constant of the format
constexpr double kFarthest = 0.05;
using Sums = std::array<double, kSums>;

std::optional<Sums> parsed(const std::string& mark) {
  std::istringstream words(mark);
  Sums sums;
  for (double& sum : sums) {
    if (!(words >> sum)) return std::nullopt;
  }
  return words >> std::ws ? std::nullopt : std::optional(sums);
}

}  // namespace

std::string codebook_mark(const std::vector<float>& embed) {
  Sums sums = {};
  for (std::size_t i = 0; i < embed.size(); ++i) {
    const std::uint32_t bits = random_bits(kKey, {static_cast<std::uint32_t>(i), 0, 0, 0})[0];
    for (std::size_t k = 0; k < kSums; ++k) sums[k] += (bits >> k & 1) != 0 ? embed[i] : -embed[i];
  }
  std::string mark;
  for (const double sum : sums) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.6g", mark.empty() ? "" : " ", sum);
    mark += number;
  }
  return mark;
}

bool same_codebook(const std::string& a, const std::string& b) {
  const auto first = parsed(a), second = parsed(b);
  if (!first || !second) return true;
  double apart = 0, size = 0;
  for (std::size_t k = 0; k < kSums; ++k) {
    apart += std::pow((*first)[k] - (*second)[k], 2);
    size += std::pow((*first)[k], 2) + std::pow((*second)[k], 2);
  }
  return apart <= kFarthest * kFarthest * size / 2;
}

}  // namespace ps::models
