// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ps::apps {

/// @brief The options that every verb takes, and how a verb talks to the user: on stderr alone.
struct Context {
  bool verbose = false;
  bool quiet = false;
  bool json = false;  ///< print the report on stdout
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0 = one for each core

  /// A line for the user, unless quiet. It waits for flush(), so that of a run that fails early
  /// only the reason is seen.
  void say(const std::string& line) const;
  void say_once(const std::string& line) const;  ///< the same, unless it said this line before
  void detail(const std::string& line) const;    ///< only when verbose
  void warn(const std::string& line) const;      ///< "warning: ...", unless quiet
  void flush() const;                            ///< prints what waits
  bool waits() const { return !waiting_.empty(); }

 private:
  mutable std::vector<std::string> waiting_, said_once_;
};

/// @return the text on one line: runs of line breaks and blanks become one blank
std::string one_line(const std::string& text);

/// @brief Writes to the process's standard error, past the stream that decoders print to, which
/// may be hushed in another thread (io/hush.h).
void print_error(const std::string& text);

}  // namespace ps::apps
