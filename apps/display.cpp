// SPDX-License-Identifier: BSD-3-Clause
#include "apps/display.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "libps/core/error.h"

namespace ps::apps {
namespace {

bool reachable() {
  // Xlib's type is called Display as well.
  if (::Display* display = XOpenDisplay(nullptr)) {
    XCloseDisplay(display);
    return true;
  }
  return false;
}

/// Becomes Xvfb, which writes the number of the display it chose to `report`. Runs in the child.
[[noreturn]] void become_xvfb(int report) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // ends when the program does, however it ends
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, fd);
  const std::string fd = std::to_string(report);
  execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1280x1024x24", "-nolisten",
         "tcp", "-noreset", static_cast<char*>(nullptr));
  _exit(127);
}

/// @return what Xvfb says, up to the line's end; empty when it ends, or says nothing for 20 seconds
std::string read_line(int fd) {
  constexpr int kMilliseconds = 20000;
  std::string line;
  char c = 0;
  pollfd ready = {fd, POLLIN, 0};
  while (poll(&ready, 1, kMilliseconds) == 1 && read(fd, &c, 1) == 1) {
    if (c == '\n') return line;
    line += c;
  }
  return "";
}

}  // namespace

Display::Display(Need need) {
  if (reachable()) return;
  if (need == Need::window) {
    throw Error("view", "no X display can be reached",
                "DISPLAY to name one, or --screenshot F.png");
  }
  int ends[2];
  if (pipe(ends) != 0) throw Error("view", "no pipe to Xvfb can be made");
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  server_ = fork();
  if (server_ == 0) become_xvfb(ends[1]);
  close(ends[1]);
  const std::string number = server_ > 0 ? read_line(ends[0]) : "";
  close(ends[0]);
  setenv("DISPLAY", (":" + number).c_str(), 1);
  if (!number.empty() && reachable()) return;
  this->~Display();
  throw Error("view", "no X display can be reached, and Xvfb does not start",
              "DISPLAY to name one, or xvfb installed (apt install xvfb)");
}

Display::~Display() {
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
  server_ = 0;
}

}  // namespace ps::apps
