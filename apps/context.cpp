// SPDX-License-Identifier: BSD-3-Clause
#include "apps/context.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace ps::apps {

void Context::say(const std::string& line) const {
  if (!quiet) waiting_.push_back(line);
  if (verbose) flush();
}

void Context::say_once(const std::string& line) const {
  if (std::find(said_once_.begin(), said_once_.end(), line) != said_once_.end()) return;
  said_once_.push_back(line);
  say(line);
}

void Context::detail(const std::string& line) const {
  if (verbose) say(line);
}

void Context::warn(const std::string& line) const { say("warning: " + line); }

void Context::flush() const {
  for (const std::string& line : waiting_) print_error(line + "\n");
  waiting_.clear();
}

void print_error(const std::string& text) { dprintf(STDERR_FILENO, "%s", text.c_str()); }

std::string one_line(const std::string& text) {
  std::string line;
  for (const unsigned char c : text) {
    if (!std::isspace(c)) {
      line += static_cast<char>(c);
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

}  // namespace ps::apps
