// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_axis.h"

#include <algorithm>
#include <cmath>

#include "libps/core/words.h"

namespace ps::apps {
namespace {

std::string words_of(double value) { return in_digits(std::abs(value) < 1e-12 ? 0 : value); }

}  // namespace

Axis::Axis(double low, double high, bool log, double from, double to)
    : log_(log),
      low_(log ? std::log10(low) : low),
      high_(log ? std::log10(high) : high),
      from_(from),
      to_(to) {
  constexpr double kRoom = 0.07;  // of the range, beyond each end
  double room = kRoom * (high_ - low_);
  if (!(room > 0)) room = log_ ? 0.1 : std::max(1e-6, 0.1 * std::abs(low_));
  low_ -= room;
  high_ += room;
}

double Axis::at(double value) const {
  const double v = log_ ? std::log10(value) : value;
  return from_ + (to_ - from_) * (v - low_) / (high_ - low_);
}

bool Axis::holds(double value) const {
  if (!std::isfinite(value) || (log_ && !(value > 0))) return false;
  const double v = log_ ? std::log10(value) : value;
  return v >= low_ && v <= high_;
}

std::vector<Tick> Axis::ticks(int most) const {
  return log_ && high_ - low_ > 0.5 ? log_ticks(most) : linear_ticks(most);
}

std::vector<Tick> Axis::linear_ticks(int most) const {
  const double low = log_ ? std::pow(10, low_) : low_, high = log_ ? std::pow(10, high_) : high_;
  const double raw = (high - low) / most, power = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= raw) step = factor * power;
  }
  std::vector<Tick> ticks;
  for (double i = std::ceil(low / step); i * step <= high; ++i) {
    ticks.push_back({i * step, words_of(i * step)});
  }
  return ticks;
}

std::vector<Tick> Axis::log_ticks(int most) const {
  const auto fitting = [&](const std::vector<double>& factors, int every) {
    std::vector<Tick> ticks;
    for (int power = static_cast<int>(std::floor(low_)); power <= high_; ++power) {
      if (power % every != 0) continue;
      for (const double factor : factors) {
        const double value = factor * std::pow(10, power);
        if (holds(value)) ticks.push_back({value, words_of(value)});
      }
    }
    return ticks;
  };
  const auto few = [&](const std::vector<Tick>& ticks) {
    return ticks.size() <= static_cast<std::size_t>(most);
  };
  for (const std::vector<double>& factors : {std::vector<double>{1, 2, 5}, {1, 3}, {1}}) {
    const std::vector<Tick> ticks = fitting(factors, 1);
    if (few(ticks)) return ticks;
  }
  for (int every = 2;; ++every) {
    const std::vector<Tick> ticks = fitting({1}, every);
    if (few(ticks)) return ticks;
  }
}

}  // namespace ps::apps
