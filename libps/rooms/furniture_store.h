// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "libps/rooms/furniture.h"
#include "libps/rooms/tree.h"

namespace ps::rooms {

/// What a model can stand in for, by the words of its name.
enum class Role { seat, couch, table, bed, storage, plant, door, other };
constexpr int kRoles = 8;

/// Where a model belongs, by its size and elevation.
enum class Use { floor, top, wall, ceiling, none };

struct StoredModel {
  std::string name, category;
  float elevation = 0;
  Role role = Role::other;
  Use use = Use::none;
  Vec low, high;
  bool flat_top = false;  ///< things can stand on it
  Mesh mesh;
  std::vector<Material> materials;
  std::vector<Picture> pictures;

  Vec size() const { return high - low; }
  /// The mesh's tree, built when it is first asked for; by any thread.
  const Tree& tree() const;

 private:
  struct Late {
    std::once_flag once;
    Tree tree;
  };
  std::unique_ptr<Late> late_ = std::make_unique<Late>();
};

struct FurnitureStore {
  std::vector<StoredModel> models;
  std::array<std::vector<int>, kRoles> on_floor;  ///< indices of models by role
  std::vector<int> on_top, on_wall, on_ceiling;
};

}  // namespace ps::rooms
