// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/stress_given.h"

#include <algorithm>
#include <map>

#include "libps/scene/stress_axes.h"
#include "libps/scene/stress_world.h"

namespace ps::stress {
namespace {

constexpr double kMostTurned = 30, kMostMoved = .5;  ///< degrees and metres, between neighbours

bool overlap(const Pose& a, const Pose& b) {
  const Eigen::Quaterniond from(a.linear()), to(b.linear());
  return from.angularDistance(to) * 180 / CV_PI <= kMostTurned &&
         (a.translation() - b.translation()).norm() <= kMostMoved;
}

/// Evenly spread over the middle `length` of these.
std::vector<std::size_t> spread(const std::vector<std::size_t>& all, std::size_t length,
                                std::size_t count) {
  const std::size_t start = (all.size() - length) / 2;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < count; ++i) {
    some.push_back(all[start + (length - 1) * i / (count - 1)]);
  }
  return some;
}

std::vector<std::size_t> overlapping(const std::vector<std::size_t>& all,
                                     const std::function<Pose(std::size_t)>& pose,
                                     std::size_t count) {
  count = std::min(count, all.size());
  for (std::size_t length = all.size();; length = std::max(count, length - length / 4)) {
    const std::vector<std::size_t> some = spread(all, length, count);
    const bool together =
        std::adjacent_find(some.begin(), some.end(), [&](std::size_t a, std::size_t b) {
          return !overlap(pose(a), pose(b));
        }) == some.end();
    if (together || length == count) return some;
  }
}

WalkChoice divided(const std::vector<std::size_t>& all, const SuiteOptions& options) {
  const auto most = static_cast<std::size_t>(options.frames + options.held_out);
  const std::size_t held =
      std::max<std::size_t>(1, all.size() * static_cast<std::size_t>(options.held_out) / most);
  WalkChoice walk;
  for (std::size_t i = 0, k = 0; i < all.size(); ++i) {
    const bool left_out = k < held && i == (2 * k + 1) * all.size() / (2 * held);
    (left_out ? walk.held_out : walk.frames).push_back(all[i]);
    k += left_out;
  }
  return walk;
}

}  // namespace

std::vector<WalkChoice> choose_walks(const std::vector<int>& worlds,
                                     const std::function<Pose(std::size_t)>& pose,
                                     const SuiteOptions& options) {
  constexpr std::size_t kLeast = 3;
  std::map<int, std::vector<std::size_t>> by_world;
  for (std::size_t i = 0; i < worlds.size(); ++i) by_world[worlds[i]].push_back(i);
  std::vector<WalkChoice> walks;
  for (const auto& [world, all] : by_world) {
    if (all.size() < kLeast) continue;
    if (walks.size() == static_cast<std::size_t>(options.rooms)) break;
    const auto count = static_cast<std::size_t>(options.frames + options.held_out);
    walks.push_back(divided(overlapping(all, pose, count), options));
  }
  return walks;
}

View reduced(const View& view, cv::Size most) {
  const double times = std::max(static_cast<double>(view.color.cols) / most.width,
                                static_cast<double>(view.color.rows) / most.height);
  return times > 1 ? shrunk(view, times) : view;
}

World given_world(const GivenFrames::Walk& walk, cv::Size size) {
  World world;
  for (const View& view : walk.frames) world.frames.push_back(reduced(view, size));
  for (const View& view : walk.held_out) world.held_out.push_back(reduced(view, size));
  return completed(std::move(world));
}

Photo given_photo(const GivenFrames::Pair& pair, cv::Size size) {
  Photo photo;
  photo.known = reduced(pair.photo, size);
  photo.view = photo.known;
  const View target = reduced(pair.target, size);
  photo.lens = target.intrinsics;
  photo.world_from_cam = target.world_from_cam;
  photo.shoot = [known = photo.known, target](const Intrinsics&, const Pose& pose) {
    return pose.isApprox(known.world_from_cam, 1e-9) ? known : target;
  };
  return photo;
}

}  // namespace ps::stress
