// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "libps/rooms/furniture.h"

namespace ps::rooms {

enum class RoomKind { bedroom, living_room, kitchen, office, bathroom, corridor, hall, storage };
constexpr int kRoomKinds = 8;

/// @return "bedroom", "living room", ...
std::string to_string(RoomKind kind);

struct RoomOptions {
  /// Real models to place beside procedural ones (about half of the pieces); may be null.
  const Furniture* furniture = nullptr;
  bool mirrors = false;  ///< mirrors show what they reflect; their depth is that of the glass
};

struct Scene;  // Internal: triangles, materials, lights.

/// @brief A furnished room with what can be seen from it: open doors lead to further lit rooms,
/// windows to an outside without depth. World axes: x right, y up, z towards the viewer; metres;
/// the floor is y = 0.
///
/// A function of (seed, options) alone, as one compiler builds it (the order in which arguments are
/// made is its choice). Immutable, may be used from many threads at once; copies
/// share and are cheap.
class Room {
 public:
  explicit Room(std::uint64_t seed, const RoomOptions& options = {});

  RoomKind kind() const;
  /// @return the smallest and the largest corner of the main room, metres
  std::array<std::array<float, 3>, 2> bounds() const;

  const Scene& scene() const { return *scene_; }

 private:
  std::shared_ptr<const Scene> scene_;
};

}  // namespace ps::rooms
