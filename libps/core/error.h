// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace ps {

/// @brief The one error type of the toolkit.
///
/// The message is one line: where, what is wrong, and what would be right, for example
/// `depth/00003.png: 100 of 194400 rows are missing; expected 540x360 pixels`.
/// Everything in `libps` and `io` that fails on its input throws this and nothing else.
class Error : public std::runtime_error {
 public:
  /// @param where     file, option or argument the fault is in
  /// @param what      what is wrong with it
  /// @param expected  what would be right; may be empty
  Error(const std::string& where, const std::string& what, const std::string& expected = "")
      : std::runtime_error(where + ": " + what +
                           (expected.empty() ? "" : "; expected " + expected)) {}
};

}  // namespace ps
