// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "libps/core/random.h"
#include "libps/rooms/vec.h"

namespace ps::rooms {

/// A stream of random numbers, a function of (seed, stream) alone.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint32_t stream) : seed_(seed), stream_(stream) {}

  std::uint32_t bits() {
    if (left_ == 0) {
      words_ = random_bits(seed_, {stream_, count_++, 0, 0x726f6f6d});
      left_ = 4;
    }
    return words_[--left_];
  }
  float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
  float range(float low, float high) { return low + (high - low) * unit(); }
  int below(int count) {
    return static_cast<int>(static_cast<std::uint64_t>(bits()) * count >> 32);
  }
  int whole(int low, int high) { return low + below(high - low + 1); }  ///< both may come
  bool chance(float p) { return unit() < p; }
  float sign() { return chance(0.5f) ? 1.f : -1.f; }
  /// About N(0, 1): a sum of four.
  float normal() { return (unit() + unit() + unit() + unit() - 2) * 1.7320508f; }
  template <typename T>
  T pick(std::initializer_list<T> values) {
    return values.begin()[below(static_cast<int>(values.size()))];
  }
  Dice child() {
    return Dice(seed_ ^ (static_cast<std::uint64_t>(bits()) << 32 | bits()), stream_);
  }

 private:
  std::uint64_t seed_;
  std::uint32_t stream_;
  std::uint32_t count_ = 0;
  int left_ = 0;
  std::array<std::uint32_t, 4> words_{};
};

}  // namespace ps::rooms
