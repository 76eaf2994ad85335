// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/room.h"

#include "libps/rooms/light.h"
#include "libps/rooms/scene.h"

namespace ps::rooms {
namespace {

/// The scene's own meshes come first.
void gather_parts(Scene& scene) {
  std::vector<Part> all(2);
  all[0].mesh = &scene.solid;
  all[0].tree = &scene.solid_tree;
  all[1].mesh = &scene.lamps;
  all[1].tree = &scene.lamp_tree;
  all[1].casts = false;
  for (Part& p : all) {
    p.materials = &scene.materials;
    p.pictures = &scene.pictures;
  }
  std::vector<std::array<Vec, 2>> boxes;
  for (const Part& p : scene.parts) boxes.push_back({p.low, p.high});
  scene.part_tree = Tree(boxes);
  all.insert(all.end(), scene.parts.begin(), scene.parts.end());
  scene.parts = std::move(all);
}

}  // namespace

std::string to_string(RoomKind kind) {
  constexpr const char* names[kRoomKinds] = {"bedroom",  "living room", "kitchen", "office",
                                             "bathroom", "corridor",    "hall",    "storage"};
  return names[static_cast<int>(kind)];
}

Room::Room(std::uint64_t seed, const RoomOptions& options) {
  auto scene = std::make_shared<Scene>();
  if (options.furniture) scene->furniture = options.furniture->share();
  furnish(*scene, seed, options);
  scene->solid_tree = Tree(scene->solid);
  scene->lamp_tree = Tree(scene->lamps);
  gather_parts(*scene);
  bake(*scene);
  scene_ = std::move(scene);
}

RoomKind Room::kind() const { return scene_->spaces[0].kind; }

std::array<std::array<float, 3>, 2> Room::bounds() const {
  const Space& s = scene_->spaces[0];
  return {{{s.low.x, s.low.y, s.low.z}, {s.high.x, s.high.y, s.high.z}}};
}

}  // namespace ps::rooms
