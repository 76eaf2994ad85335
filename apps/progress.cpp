// SPDX-License-Identifier: BSD-3-Clause
#include "apps/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "apps/interrupt.h"

namespace ps::apps {
namespace {

constexpr const char* kClear = "\r\033[K";  ///< an empty line in place of the bar
constexpr double kBetweenDraws = 0.1;       ///< seconds

int terminal_columns() {
  winsize size = {};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

std::string clock_time(double seconds) {
  const long whole = std::lround(std::min(seconds, 359999.0));
  char text[32];
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  }
  return text;
}

}  // namespace

std::string progress_line(const std::string& what, std::size_t done, std::size_t total,
                          double seconds, int width) {
  const double share = total == 0 ? 1 : static_cast<double>(done) / static_cast<double>(total);
  const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
  char before[64], after[96];
  std::snprintf(before, sizeof before, "%.40s %3.0f%% ", what.c_str(), 100 * share);
  const std::string left =
      rate > 0 ? clock_time(static_cast<double>(total - done) / rate) + " left" : "";
  std::snprintf(after, sizeof after, " %zu/%zu  %.1f/s  %s", done, total, rate, left.c_str());
  const std::string words = std::string(before) + after;
  const int bar = std::min(40, width - static_cast<int>(words.size()) - 3);
  if (bar < 5) return words.substr(0, static_cast<std::size_t>(std::max(0, width - 1)));
  const int full = static_cast<int>(share * bar);
  std::string drawn = std::string(static_cast<std::size_t>(full), '=');
  if (full < bar) drawn += '>' + std::string(static_cast<std::size_t>(bar - full - 1), ' ');
  return before + ('[' + drawn + ']') + after;
}

Progress::Progress(const Context& context, std::string what, std::size_t total)
    : context_(context),
      what_(std::move(what)),
      total_(total),
      visible_(!context.quiet && isatty(STDERR_FILENO) == 1) {
  update(0);
}

Progress::~Progress() {
  if (drawn_) print_error(kClear);
}

void Progress::update(std::size_t done) {
  throw_if_interrupted();
  if (done > 0 && context_.waits()) {
    if (drawn_) print_error(kClear);
    context_.flush();
  }
  if (!visible_ || (drawn_ && done < total_ && seconds_since(last_) < kBetweenDraws)) return;
  last_ = now();
  drawn_ = true;
  const std::string line =
      progress_line(what_, done, total_, seconds_since(start_), terminal_columns());
  print_error("\r" + line + "\033[K");
}

}  // namespace ps::apps
