// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "apps/context.h"
#include "libps/core/clock.h"

namespace ps::apps {

/// @brief One line of a progress bar: `fuse  42% [=====>     ] 156/373  41.2/s  0:05 left`.
/// @param width  columns the line may fill; the bar takes what the words leave
std::string progress_line(const std::string& what, std::size_t done, std::size_t total,
                          double seconds, int width);

/// @brief A bar with rate and time left on stderr, when that is a terminal and the user wants
/// words.
class Progress {
 public:
  Progress(const Context& context, std::string what, std::size_t total);
  ~Progress();  ///< clears the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Lines that wait in the context are printed once something is done.
  /// Throws Interrupted when the user asked the program to end.
  void update(std::size_t done);

 private:
  const Context& context_;
  std::string what_;
  std::size_t total_;
  bool visible_;
  bool drawn_ = false;
  Instant start_ = now();
  Instant last_;
};

}  // namespace ps::apps
