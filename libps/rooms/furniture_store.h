// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <string>
#include <vector>

#include "libps/rooms/furniture.h"
#include "libps/rooms/tree.h"

namespace ps::rooms {

struct StoredModel {
  std::string name, category;
  float elevation = 0;
  bool door_or_window = false;
  Vec low, high;
  Mesh mesh;
  Tree tree;
  std::vector<Material> materials;
  std::vector<Picture> pictures;
};

struct FurnitureStore {
  std::vector<StoredModel> models;
};

}  // namespace ps::rooms
