// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/room_examples.h"

#include "libps/core/random.h"
#include "libps/rooms/camera.h"
#include "libps/rooms/camera_effects.h"
#include "libps/scene/room_view.h"

namespace ps::train {
namespace {

enum Purpose : std::uint32_t { kCamera, kEffects, kMove, kOnlyTurned };

std::uint64_t key(std::uint64_t seed, std::uint32_t i, Purpose purpose) {
  const auto bits = random_bits(seed, {i, purpose, 0x6578u, 0});
  return (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
}

View photo(const rooms::Room& room, const rooms::Camera& camera, std::uint64_t effects) {
  rooms::Shot shot = rooms::shoot(room, camera);
  rooms::degrade(shot, effects);
  return view_of(shot, camera);
}

}  // namespace

std::vector<ExamplePair> room_pairs(std::uint64_t seed, const rooms::RoomOptions& options,
                                    int count) {
  const rooms::Room room(seed, options);
  rooms::CameraOptions lens;
  lens.width = lens.height = kSide;
  std::vector<ExamplePair> pairs;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    const rooms::Camera camera = rooms::random_camera(room, key(seed, i, kCamera), lens);
    const bool turned = random_unit(seed, {i, kOnlyTurned, 0, 0}) < 1.0 / 3;
    const rooms::Camera other =
        rooms::moved(room, camera, key(seed, i, kMove), .75f, turned ? 0 : .6f);
    // One camera took both, so its effects are the same.
    const std::uint64_t effects = key(seed, i, kEffects);
    const View first = photo(room, camera, effects), second = photo(room, other, effects);
    pairs.push_back(example_pair(first, second, first));
    pairs.back().kind = static_cast<unsigned char>(room.kind());
  }
  return pairs;
}

}  // namespace ps::train
