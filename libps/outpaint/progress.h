// SPDX-License-Identifier: BSD-3-Clause
// Internal to the outpaint room: how much of a view is done.
#pragma once

#include <algorithm>
#include <functional>

namespace ps::outpaint {

/// Thrown when a progress function returned false; never leaves the room.
struct Stopped {};

/// @brief Work done, as a share of what is to be done at most; it never falls.
class Progress {
 public:
  /// @param report  may be empty
  Progress(const std::function<bool(double done)>& report, double whole)
      : report_(report), whole_(whole) {}

  /// Some of the work in hand is done.
  void at(double work) { tell((done_ + work) / whole_); }
  /// The work in hand is done.
  void done(double work) {
    done_ += work;
    at(0);
  }
  void finish() { tell(1); }

 private:
  void tell(double share) {
    last_ = std::max(last_, std::min(share, 1.0));
    if (report_ && !report_(last_)) throw Stopped{};
  }

  const std::function<bool(double done)>& report_;
  double whole_, done_ = 0, last_ = 0;
};

}  // namespace ps::outpaint
