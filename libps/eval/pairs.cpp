// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
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

/// Frames by world.
struct Worlds {
  std::vector<std::vector<std::size_t>> frames;  ///< of each world, in their order
  std::vector<std::size_t> of;                   ///< of each frame, its world
};

Worlds worlds_of(const std::vector<int>& names) {
  Worlds worlds;
  std::map<int, std::size_t> numbers;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::size_t number = numbers.emplace(names[i], numbers.size()).first->second;
    worlds.frames.resize(numbers.size());
    worlds.frames[number].push_back(i);
    worlds.of.push_back(number);
  }
  return worlds;
}

FramePair pair_of(std::size_t source, const Pose& a, std::size_t target, const Pose& b) {
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

/// Looks for the pairs of as few frames as it can: poses may take work.
class PairSearch {
 public:
  PairSearch(const std::vector<int>& worlds, const std::function<Pose(std::size_t)>& pose,
             const PairRange& range, std::size_t most, std::uint64_t seed)
      : worlds_(worlds_of(worlds)),
        pose_(pose),
        range_(range),
        most_(most),
        seed_(seed),
        poses_(worlds_.frames.size()) {}

  /// @return of each source the first `most` of its pairs in a random order; nothing of sources
  /// whose first pair comes after `most` others' first pairs for certain
  std::vector<std::vector<Candidate>> by_source() {
    const std::size_t count = worlds_.of.size();
    std::vector<std::uint64_t> least(count);  // no pair of a source is drawn before this
    parallel_for(count, [&](std::size_t source) { least[source] = least_draw(source); });
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::tie(least[a], a) < std::tie(least[b], b);
    });
    std::vector<std::vector<Candidate>> found(count);
    std::vector<std::uint64_t> firsts;  // draws of first pairs
    for (std::size_t looked = 0; looked < count;) {
      const std::size_t batch = std::min(count - looked, std::max(most_, kBatch));
      const auto* sources = &order[looked];
      place(sources, batch);
      parallel_for(batch, [&](std::size_t i) { found[sources[i]] = candidates_of(sources[i]); });
      for (std::size_t i = 0; i < batch; ++i) {
        if (!found[sources[i]].empty()) firsts.push_back(found[sources[i]].front().draw);
      }
      looked += batch;
      if (looked < count && most_come_before(least[order[looked]], firsts)) break;
    }
    return found;
  }

 private:
  static constexpr std::size_t kBatch = 16;

  std::uint64_t draw_of(std::size_t source, std::size_t target) const {
    const auto bits = random_bits(seed_, {static_cast<std::uint32_t>(source),
                                          static_cast<std::uint32_t>(target), kPurpose, 0});
    return static_cast<std::uint64_t>(bits[0]) << 32 | bits[1];
  }

  std::uint64_t least_draw(std::size_t source) const {
    std::uint64_t least = UINT64_MAX;
    for (const std::size_t target : worlds_.frames[worlds_.of[source]]) {
      if (target != source) least = std::min(least, draw_of(source, target));
    }
    return least;
  }

  bool most_come_before(std::uint64_t draw, const std::vector<std::uint64_t>& firsts) const {
    const auto before = std::count_if(firsts.begin(), firsts.end(),
                                      [&](std::uint64_t first) { return first < draw; });
    return static_cast<std::size_t>(before) >= most_;
  }

  /// Asks for the poses of these frames' worlds.
  void place(const std::size_t* sources, std::size_t count) {
    std::set<std::size_t> fresh;
    for (std::size_t i = 0; i < count; ++i) {
      if (poses_[worlds_.of[sources[i]]].empty()) fresh.insert(worlds_.of[sources[i]]);
    }
    const std::vector<std::size_t> worlds(fresh.begin(), fresh.end());
    parallel_for(worlds.size(), [&](std::size_t w) {
      for (const std::size_t i : worlds_.frames[worlds[w]]) poses_[worlds[w]].push_back(pose_(i));
    });
  }

  std::vector<Candidate> candidates_of(std::size_t source) const {
    const std::vector<std::size_t>& frames = worlds_.frames[worlds_.of[source]];
    const std::vector<Pose>& poses = poses_[worlds_.of[source]];
    const auto self = static_cast<std::size_t>(
        std::lower_bound(frames.begin(), frames.end(), source) - frames.begin());
    std::vector<Candidate> all;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (i == self) continue;
      const FramePair pair = pair_of(source, poses[self], frames[i], poses[i]);
      const bool in_range = pair.rotation >= range_.least_rotation &&
                            pair.rotation <= range_.most_rotation &&
                            pair.distance <= range_.most_distance;
      if (in_range) all.push_back({draw_of(source, frames[i]), pair});
    }
    std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
      return std::tie(a.draw, a.pair.target) < std::tie(b.draw, b.pair.target);
    });
    all.resize(std::min(all.size(), most_));
    return all;
  }

  const Worlds worlds_;
  const std::function<Pose(std::size_t)>& pose_;
  const PairRange range_;
  const std::size_t most_;
  const std::uint64_t seed_;
  std::vector<std::vector<Pose>> poses_;  ///< by world; empty = not asked for yet
};

}  // namespace

std::vector<FramePair> choose_pairs_lazily(const std::vector<int>& worlds,
                                           const std::function<Pose(std::size_t)>& pose,
                                           const PairRange& range, std::size_t most,
                                           std::uint64_t seed) {
  check(range);
  if (most == 0) return {};
  const std::vector<std::vector<Candidate>> by_source =
      PairSearch(worlds, pose, range, most, seed).by_source();
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

std::vector<FramePair> choose_pairs(const std::vector<Pose>& world_from_cams,
                                    const std::vector<int>& worlds, const PairRange& range,
                                    std::size_t most, std::uint64_t seed) {
  if (!worlds.empty() && worlds.size() != world_from_cams.size()) {
    throw Error("pairs", "worlds of " + std::to_string(worlds.size()) + " frames",
                "of " + std::to_string(world_from_cams.size()));
  }
  const auto pose = [&](std::size_t i) { return world_from_cams[i]; };
  return choose_pairs_lazily(worlds.empty() ? std::vector<int>(world_from_cams.size(), 0) : worlds,
                             pose, range, most, seed);
}

}  // namespace ps
