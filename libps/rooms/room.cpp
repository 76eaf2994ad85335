// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/room.h"

#include "libps/rooms/light.h"
#include "libps/rooms/scene.h"

namespace ps::rooms {
namespace {

void add_part(Scene& scene, const Mesh& mesh, const Tree& tree, bool casts) {
  Part p;
  p.mesh = &mesh;
  p.tree = &tree;
  p.materials = &scene.materials;
  p.pictures = &scene.pictures;
  p.casts = casts;
  scene.parts.push_back(p);
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
  add_part(*scene, scene->solid, scene->solid_tree, true);
  add_part(*scene, scene->lamps, scene->lamp_tree, false);
  bake(*scene);
  scene_ = std::move(scene);
}

RoomKind Room::kind() const { return scene_->spaces[0].kind; }

std::array<std::array<float, 3>, 2> Room::bounds() const {
  const Space& s = scene_->spaces[0];
  return {{{s.low.x, s.low.y, s.low.z}, {s.high.x, s.high.y, s.high.z}}};
}

}  // namespace ps::rooms
