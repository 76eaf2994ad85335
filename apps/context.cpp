// SPDX-License-Identifier: BSD-3-Clause
#include "apps/context.h"

#include <cctype>
#include <cstdio>

namespace ps::apps {

void Context::say(const std::string& line) const {
  if (!quiet) std::fprintf(stderr, "%s\n", line.c_str());
}

void Context::detail(const std::string& line) const {
  if (verbose) say(line);
}

void Context::warn(const std::string& line) const { say("warning: " + line); }

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
