// SPDX-License-Identifier: BSD-3-Clause
#include "apps/interrupt.h"

#include <csignal>
#include <cstdlib>
#include <initializer_list>

namespace ps::apps {
namespace {

volatile std::sig_atomic_t noted = 0;

void note(int signal) { noted = signal; }

}  // namespace

void note_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction inherited = {};
    sigaction(signal, nullptr, &inherited);
    if (inherited.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is then an error like a full disk
}

void throw_if_interrupted() {
  if (noted != 0) throw Interrupted();
}

bool unless_interrupted(double /*share*/) {
  throw_if_interrupted();
  return true;
}

void die_of_interrupt() {
  const int signal = noted != 0 ? noted : SIGINT;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::_Exit(1);
}

}  // namespace ps::apps
