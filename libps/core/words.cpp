// SPDX-License-Identifier: BSD-3-Clause
#include "libps/core/words.h"

#include <cstdio>

namespace ps {

std::string in_digits(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  const std::string words = count == 1 ? one : many.empty() ? one + "s" : many;
  return std::to_string(count) + " " + words;
}

}  // namespace ps
