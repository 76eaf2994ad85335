// SPDX-License-Identifier: BSD-3-Clause
// Real models in the place of procedural furniture.
#include "libps/rooms/pieces.h"

namespace ps::rooms {
namespace {

constexpr float kShare = 0.5f;  ///< of the pieces that are real models

/// The category that most of a room's furniture comes from.
const char* category_of(RoomKind kind) {
  switch (kind) {
    case RoomKind::bedroom:
      return "Bedroom";
    case RoomKind::kitchen:
      return "Kitchen";
    case RoomKind::bathroom:
      return "Bathroom";
    case RoomKind::office:
      return "Office";
    case RoomKind::living_room:
    case RoomKind::hall:
      return "Living room";
    default:
      return "Miscellaneous";
  }
}

void place(Set& set, const StoredModel& m, const Frame& f) {
  if (set.scene.parts.size() + 2 >= kMostParts) return;
  Part p;
  p.mesh = &m.mesh;
  p.tree = &m.tree();
  p.materials = &m.materials;
  p.pictures = &m.pictures;
  p.placed = true;
  const Vec middle = (m.low + m.high) * 0.5f;
  p.world = f * Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-middle.x, -m.low.y, -middle.z}};
  p.low = {1e9f, 1e9f, 1e9f};
  p.high = -p.low;
  for (int c = 0; c < 8; ++c) {
    const Vec q = p.world.point(
        {c & 1 ? m.high.x : m.low.x, c & 2 ? m.high.y : m.low.y, c & 4 ? m.high.z : m.low.z});
    p.low = min(p.low, q);
    p.high = max(p.high, q);
  }
  const Vec margin{1e-3f, 1e-3f, 1e-3f};
  p.low = p.low - margin;
  p.high += margin;
  set.scene.parts.push_back(p);
}

Piece piece_of(const StoredModel& m) {
  const StoredModel* model = &m;  // the scene holds its store
  return {m.size(), [model](Set& set, Builder b) {
            place(set, *model, b.frame());
            if (!model->flat_top || model->use != Use::floor) return;
            const Vec size = model->size();
            const Frame top{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, size.y, 0}};
            set.tops.push_back({b.frame() * top, 0.9f * size.x, 0.9f * size.z, 0.4f});
          }};
}

}  // namespace

bool wants_model(const Set& set, Dice& d) { return set.scene.furniture && d.chance(kShare); }

Piece model_or(Set& set, Dice& d, Role role, RoomKind kind, Piece otherwise) {
  if (!wants_model(set, d)) return otherwise;
  const auto& all = set.scene.furniture->on_floor[static_cast<int>(role)];
  if (all.empty()) return otherwise;
  const auto& models = set.scene.furniture->models;
  int pick = all[d.below(static_cast<int>(all.size()))];
  for (int attempt = 0; attempt < 3 && models[pick].category != category_of(kind); ++attempt) {
    pick = all[d.below(static_cast<int>(all.size()))];
  }
  return piece_of(models[pick]);
}

Piece hanging_model(Set& set, Dice& d, bool ceiling, float& elevation) {
  const FurnitureStore& store = *set.scene.furniture;
  const auto& all = ceiling ? store.on_ceiling : store.on_wall;
  if (all.empty()) return {};
  const StoredModel& m = store.models[all[d.below(static_cast<int>(all.size()))]];
  elevation = m.elevation;
  return piece_of(m);
}

bool model_clutter(Set& set, Dice& d, const Frame& f, float width, float depth, float height) {
  const FurnitureStore& store = *set.scene.furniture;
  for (int attempt = 0; attempt < 8 && !store.on_top.empty(); ++attempt) {
    const StoredModel& m =
        store.models[store.on_top[d.below(static_cast<int>(store.on_top.size()))]];
    const Vec size = m.size();
    if (size.x > 1.1f * width || size.z > 1.1f * depth || size.y > height) continue;
    place(set, m, f);
    return true;
  }
  return false;
}

}  // namespace ps::rooms
