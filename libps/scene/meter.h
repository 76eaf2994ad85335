// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: how much of a long piece of work is done.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>

namespace ps {

/// @brief Tells what share of work in stages is done: from 0 to 1, and never falling.
class Meter {
 public:
  /// @param tell  may be empty; called by one thread at a time, from any. What it throws comes out
  /// of the call below that made it.
  explicit Meter(std::function<void(double done)> tell) : tell_(std::move(tell)) {}

  /// Begins a stage of `count` parts, at whose end this share of all is done.
  void stage(double until, std::size_t count) {
    begin_ = until_;
    until_ = std::max(begin_, std::min(until, 1.0));
    count_ = std::max<std::size_t>(count, 1);
    done_ = 0;
    add(0);
  }

  /// The same where nobody knows how many stages come: it takes this share of what is left.
  void stage_of_rest(double share, std::size_t count) {
    stage(until_ + share * (1 - until_), count);
  }

  /// Parts of the stage are done; any thread may say so. A thread that comes while another tells
  /// goes on.
  void add(std::size_t parts) {
    const std::size_t done = done_ += parts;
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock || !tell_) return;
    const double share = static_cast<double>(std::min(done, count_)) / static_cast<double>(count_);
    last_ = std::max(last_, begin_ + share * (until_ - begin_));
    tell_(last_);
  }

 private:
  const std::function<void(double done)> tell_;
  std::mutex mutex_;
  std::atomic<std::size_t> done_{0};
  std::size_t count_ = 1;
  double begin_ = 0, until_ = 0, last_ = 0;
};

}  // namespace ps
