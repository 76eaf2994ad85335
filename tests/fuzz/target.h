// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "libps/core/error.h"

/// Defines a libFuzzer target: `parse(bytes)` may return or throw ps::Error; all else is a finding.
#define PS_FUZZ(parse)                                                             \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t n) { \
    try {                                                                          \
      parse(std::string_view(reinterpret_cast<const char*>(data), n));             \
    } catch (const ps::Error&) {                                                   \
    }                                                                              \
    return 0;                                                                      \
  }
