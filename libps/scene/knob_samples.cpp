// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/knob_samples.h"

#include <algorithm>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "libps/scene/room_view.h"

namespace ps {
namespace {

constexpr std::size_t kOthers = 4;
constexpr std::uint32_t kPurpose = 0x6b6e6f62;  ///< of the random numbers

std::uint64_t key(std::uint64_t seed, std::uint32_t round, std::uint32_t view) {
  const auto bits = random_bits(seed, {round, view, kPurpose, 0});
  return static_cast<std::uint64_t>(bits[0]) << 32 | bits[1];
}

/// Cameras of one place: the pair, then the others. Empty where they are no pair.
std::vector<rooms::Camera> cameras_of(const rooms::Room& room, std::uint64_t seed,
                                      std::uint32_t round, int side) {
  constexpr float kTurned = 1, kMoved = 0.6f;  // radians, metres
  rooms::CameraOptions options;
  options.width = options.height = side;
  std::vector<rooms::Camera> cameras = {rooms::random_camera(room, key(seed, round, 0), options)};
  std::vector<Pose> poses = {room_pose(cameras.front())};
  for (std::uint32_t view = 1; view < kOthers + 2; ++view) {
    cameras.push_back(rooms::moved(room, cameras.front(), key(seed, round, view), kTurned, kMoved));
    poses.push_back(room_pose(cameras.back()));
  }
  for (const FramePair& pair : choose_pairs(poses, {}, {}, poses.size(), seed)) {
    if (pair.source != 0) continue;
    std::swap(cameras[1], cameras[pair.target]);
    return cameras;
  }
  return {};
}

}  // namespace

KnobSample room_sample(std::uint64_t seed, int side) {
  constexpr std::uint32_t kMostRounds = 50;
  const rooms::Room room(seed);
  for (std::uint32_t round = 0; round < kMostRounds; ++round) {
    const std::vector<rooms::Camera> cameras = cameras_of(room, seed, round, side);
    if (cameras.empty()) continue;
    std::vector<View> views(cameras.size());
    parallel_for(views.size(), [&](std::size_t i) {
      views[i] = shoot_view(room, cameras[i]);
    });
    return {"room-" + std::to_string(seed),  0, views[0], views[1], {},
            {views.begin() + 2, views.end()}};
  }
  throw Error("room " + std::to_string(seed), "no two views of it are a pair", "another seed");
}

std::vector<FrameSet> choose_frame_sets(const std::vector<int>& worlds,
                                        const std::function<Pose(std::size_t)>& pose,
                                        std::size_t most, std::size_t apart, std::uint64_t seed) {
  std::vector<FrameSet> sets;
  for (const FramePair& pair : choose_pairs_lazily(worlds, pose, {}, most, seed)) {
    const Pose target = pose(pair.target);
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
      const std::size_t steps = i > pair.target ? i - pair.target : pair.target - i;
      if (i == pair.source || steps < std::max<std::size_t>(1, apart)) continue;
      if (worlds[i] != worlds[pair.target]) continue;
      const Pose other = pose(i);
      const Eigen::AngleAxisd turn(target.linear().transpose() * other.linear());
      near.emplace_back((target.translation() - other.translation()).norm() + turn.angle(), i);
    }
    const std::size_t count = std::min(kOthers, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    sets.push_back({pair, {}});
    for (std::size_t i = 0; i < count; ++i) sets.back().others.push_back(near[i].second);
    std::sort(sets.back().others.begin(), sets.back().others.end());
  }
  return sets;
}

}  // namespace ps
