// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>

namespace ps::apps {

/// Thrown by throw_if_interrupted(), so that destructors remove what is half-written.
struct Interrupted : std::exception {
  explicit Interrupted(const char* message = "interrupted; nothing was written")
      : message_(message) {}
  const char* what() const noexcept override { return message_; }

 private:
  const char* message_;  ///< a literal: what became of the outputs
};

/// @brief From now on the first SIGINT, SIGTERM or SIGHUP is noted instead of ending the program; a
/// second one ends it at once. A signal that the caller had ignored (nohup, a job in the background
/// of a script) stays ignored. For verbs that write.
void note_interrupts();

void throw_if_interrupted();

/// @brief For work that tells how far it is, but is stopped by the user alone: calls
/// throw_if_interrupted().
/// @return true: go on
bool unless_interrupted(double share);

/// @brief Ends the program the way the noted signal would have, so that shells can tell.
[[noreturn]] void die_of_interrupt();

}  // namespace ps::apps
