// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdint>
#include <optional>

#include "io/posed_layouts.h"
#include "io/text.h"
#include "libps/core/error.h"
#include "libps/core/random.h"
#include "libps/scene/room_view.h"

namespace ps {
namespace {

constexpr int kViews = 4;                              ///< of each room
constexpr float kMostTurned = 1.047f, kMostMoved = 1;  ///< radians, metres

struct RoomSource {
  std::uint64_t seed = 0;
  std::size_t count = 0;

  std::uint64_t room_seed(std::size_t frame) const { return room_number(seed, frame / kViews); }
};

RoomSource parse(const std::string& data) {
  const std::string_view text(data);
  const std::size_t first = text.find(':'), second = text.find(':', first + 1);
  if (second != std::string_view::npos) {
    const auto seed = to_number<std::uint64_t>(text.substr(first + 1, second - first - 1));
    const auto count = to_number<std::uint64_t>(text.substr(second + 1));
    if (seed && count && *seed<UINT64_MAX / kRoomsOfSeed&& * count> 0 &&
        *count <= kViews * kRoomsOfSeed) {
      return {*seed, static_cast<std::size_t>(*count)};
    }
  }
  throw Error(data, "names no rooms", "rooms:SEED:COUNT, as rooms:7:400, of 1 to 4000000 views");
}

std::uint64_t key(std::uint64_t room_seed, std::size_t view) {
  const auto bits = random_bits(room_seed, {static_cast<std::uint32_t>(view), 0, 0x6576616cu, 0});
  return static_cast<std::uint64_t>(bits[0]) << 32 | bits[1];
}

rooms::Camera camera_of(const rooms::Room& room, std::uint64_t room_seed, std::size_t view) {
  const rooms::Camera first = rooms::random_camera(room, key(room_seed, 0));
  if (view == 0) return first;
  return rooms::moved(room, first, key(room_seed, view), kMostTurned, kMostMoved);
}

/// Those of one room are asked for together: the last room's are kept.
Pose pose_of(const RoomSource& source, std::size_t i) {
  struct Kept {
    std::optional<std::uint64_t> room;
    std::array<Pose, kViews> poses;
  };
  thread_local Kept kept;
  const std::uint64_t seed = source.room_seed(i);
  if (kept.room != seed) {
    kept.room.reset();
    const rooms::Room room(seed);
    for (std::size_t view = 0; view < kViews; ++view) {
      kept.poses[view] = room_pose(camera_of(room, seed, view));
    }
    kept.room = seed;
  }
  return kept.poses[i % kViews];
}

View load(const RoomSource& source, std::size_t i) {
  const rooms::Room room(source.room_seed(i));
  return shoot_view(room, camera_of(room, source.room_seed(i), i % kViews));
}

}  // namespace

PosedFrames open_room_frames(const std::string& data) {
  const RoomSource source = parse(data);
  PosedFrames frames;
  frames.layout = "rooms";
  frames.frames.reserve(source.count);
  for (std::size_t i = 0; i < source.count; ++i) {
    frames.frames.push_back(
        {"room-" + std::to_string(source.room_seed(i)) + "-" + std::to_string(i % kViews),
         static_cast<double>(i), static_cast<int>(i / kViews)});
  }
  frames.pose = [source](std::size_t i) { return pose_of(source, i); };
  frames.load = [source](std::size_t i) { return load(source, i); };
  return frames;
}

}  // namespace ps
