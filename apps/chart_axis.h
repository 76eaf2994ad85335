// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ps::apps {

struct Tick {
  double value = 0;
  std::string words;
};

/// @brief Values in a row of pixels, linear or logarithmic.
class Axis {
 public:
  /// @param low, high    that it must hold, finite; above 0 if `log`
  /// @param from, to     pixels of its ends; room is left beyond low and high
  Axis(double low, double high, bool log, double from, double to);

  double at(double value) const;  ///< pixels
  bool holds(double value) const;
  /// @return round values (1, 2, 5 times a power of ten) in rising order, about `most` at most
  std::vector<Tick> ticks(int most) const;

 private:
  std::vector<Tick> linear_ticks(int most) const;
  std::vector<Tick> log_ticks(int most) const;

  bool log_;
  double low_, high_;  ///< logarithms if log_
  double from_, to_;
};

}  // namespace ps::apps
