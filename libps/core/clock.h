// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace ps {

/// A moment, on a clock that is never put back.
using Instant = std::chrono::steady_clock::time_point;

inline Instant now() { return std::chrono::steady_clock::now(); }

inline double seconds_since(Instant start) {
  return std::chrono::duration<double>(now() - start).count();
}

/// Adds the seconds of its life to a sum.
class AddedSeconds {
 public:
  explicit AddedSeconds(double& sum) : sum_(sum) {}
  ~AddedSeconds() { sum_ += seconds_since(start_); }
  AddedSeconds(const AddedSeconds&) = delete;
  AddedSeconds& operator=(const AddedSeconds&) = delete;

 private:
  double& sum_;
  const Instant start_ = now();
};

}  // namespace ps
