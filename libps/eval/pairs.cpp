// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/pairs.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"

namespace ps {
namespace {

constexpr std::uint32_t kPurpose = 0x70616972;  ///< of the random numbers

void check(const PairRange& range) {
  const bool sound = range.least_rotation >= 0 && range.most_rotation <= 180 &&
                     range.least_rotation <= range.most_rotation && range.most_distance >= 0;
  if (sound) return;
  throw Error("pairs",
              std::to_string(range.least_rotation) + " to " + std::to_string(range.most_rotation) +
                  " degrees, " + std::to_string(range.most_distance) + " m",
              "rotations from 0 to 180, the least first, and a distance of 0 or more");
}

FramePair pair_of(const std::vector<Pose>& poses, std::size_t source, std::size_t target) {
  const Pose &a = poses[source], &b = poses[target];
  const Eigen::Quaterniond turn(a.linear().transpose() * b.linear());
  // atan2 is exact for small angles, where the arc cosine of a trace is not.
  const double angle = 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
  return {source, target, angle * 180 / M_PI, (a.translation() - b.translation()).norm()};
}

/// A pair, and its place among its source's in a random order.
struct Candidate {
  std::uint64_t draw;
  FramePair pair;
};

/// The first `most` of a frame's pairs in a random order.
std::vector<Candidate> candidates_of(std::size_t source, const std::vector<Pose>& poses,
                                     const std::vector<int>& worlds, const PairRange& range,
                                     std::size_t most, std::uint64_t seed) {
  std::vector<Candidate> all;
  for (std::size_t target = 0; target < poses.size(); ++target) {
    if (target == source || (!worlds.empty() && worlds[source] != worlds[target])) continue;
    const FramePair pair = pair_of(poses, source, target);
    if (pair.rotation < range.least_rotation || pair.rotation > range.most_rotation ||
        pair.distance > range.most_distance) {
      continue;
    }
    const auto bits = random_bits(seed, {static_cast<std::uint32_t>(source),
                                         static_cast<std::uint32_t>(target), kPurpose, 0});
    all.push_back({static_cast<std::uint64_t>(bits[0]) << 32 | bits[1], pair});
  }
  std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.draw, a.pair.target) < std::tie(b.draw, b.pair.target);
  });
  all.resize(std::min(all.size(), most));
  return all;
}

}  // namespace

std::vector<FramePair> choose_pairs(const std::vector<Pose>& world_from_cams,
                                    const std::vector<int>& worlds, const PairRange& range,
                                    std::size_t most, std::uint64_t seed) {
  check(range);
  if (!worlds.empty() && worlds.size() != world_from_cams.size()) {
    throw Error("pairs", "worlds of " + std::to_string(worlds.size()) + " frames",
                "of " + std::to_string(world_from_cams.size()));
  }
  std::vector<std::vector<Candidate>> by_source(world_from_cams.size());
  parallel_for(by_source.size(), [&](std::size_t source) {
    by_source[source] = candidates_of(source, world_from_cams, worlds, range, most, seed);
  });
  // Every source's first pair comes before any source's second.
  std::vector<FramePair> chosen;
  for (std::size_t round = 0; chosen.size() < most; ++round) {
    std::vector<Candidate> drawn;
    for (const auto& candidates : by_source) {
      if (round < candidates.size()) drawn.push_back(candidates[round]);
    }
    if (drawn.empty()) break;
    std::sort(drawn.begin(), drawn.end(), [](const Candidate& a, const Candidate& b) {
      return std::tie(a.draw, a.pair.source) < std::tie(b.draw, b.pair.source);
    });
    drawn.resize(std::min(drawn.size(), most - chosen.size()));
    for (const Candidate& candidate : drawn) chosen.push_back(candidate.pair);
  }
  std::sort(chosen.begin(), chosen.end(), [](const FramePair& a, const FramePair& b) {
    return std::tie(a.source, a.target) < std::tie(b.source, b.target);
  });
  return chosen;
}

}  // namespace ps
