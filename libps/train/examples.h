// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "io/safetensors.h"
#include "libps/geometry/view.h"
#include "libps/train/shard.h"

namespace ps::train {

constexpr int kSide = 256;  ///< pixels of an example: what networks see

/// Two views of one place; each of kSide x kSide pixels.
struct ExamplePair {
  struct Half {
    Image color;
    Depth depth;      ///< metres, 0 = unknown
    Intrinsics lens;  ///< of kSide x kSide pixels
  };
  Half first, second;
  Pose first_from_second = Pose::Identity();
  unsigned char kind = kUnknownKind;  ///< of room
  Image splat;             ///< the first, lifted and splatted into the second; behind it 0.5
  cv::Mat1b flags;         ///< kHit and kMissing
  std::vector<int> order;  ///< of the second's cells (SPEC.md 6)
};

/// @param first, second  of kSide x kSide pixels
/// @param source  what is lifted for the splat: the first, or the frame it is cut from
ExamplePair example_pair(const View& first, const View& second, const View& source);

/// @brief Random upright squares of two real frames, 60 to 100 % of their short sides; the first is
/// lifted whole.
ExamplePair frame_pair(const View& first, const View& second, std::uint64_t seed);

/// @brief Pairs as a shard (shard.h).
TensorMap to_shard(const std::vector<ExamplePair>& pairs);

}  // namespace ps::train
