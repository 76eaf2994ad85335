// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/furniture.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/rooms/furniture_store.h"

namespace ps::rooms {
namespace {

void check(const Model& m) {
  const std::string where = "model " + m.name;
  for (const auto& p : m.positions) {
    for (const float x : p) {
      if (!std::isfinite(x)) throw Error(where, "a coordinate is no finite number");
    }
  }
  if (!m.uvs.empty() && m.uvs.size() != m.positions.size()) {
    throw Error(where, std::to_string(m.uvs.size()) + " uvs",
                "none or one for each of " + std::to_string(m.positions.size()) + " positions");
  }
  for (const auto& t : m.triangles) {
    for (const std::uint32_t c : t.corners) {
      if (c >= m.positions.size()) {
        throw Error(where, "a triangle names position " + std::to_string(c),
                    "less than " + std::to_string(m.positions.size()));
      }
    }
    if (t.material >= m.materials.size()) {
      throw Error(where, "a triangle names material " + std::to_string(t.material),
                  "less than " + std::to_string(m.materials.size()));
    }
  }
  for (const auto& material : m.materials) {
    if (material.texture >= static_cast<int>(m.textures.size())) {
      throw Error(where, "a material names texture " + std::to_string(material.texture),
                  "less than " + std::to_string(m.textures.size()));
    }
  }
  for (const auto& t : m.textures) {
    if (t.width <= 0 || t.height <= 0 ||
        t.rgb.size() != static_cast<std::size_t>(t.width) * t.height * 3) {
      throw Error(where,
                  "a texture of " + std::to_string(t.width) + "x" + std::to_string(t.height) +
                      " has " + std::to_string(t.rgb.size()) + " bytes",
                  "three for each of at least one texel");
    }
  }
}

Material to_material(const ModelMaterial& m) {
  Material out;
  out.color = linear_from_srgb(Vec{clamp01(m.color[0]), clamp01(m.color[1]), clamp01(m.color[2])});
  if (m.texture >= 0) {
    out.pattern = Pattern::picture;
    out.picture = m.texture;
  }
  return out;
}

Vec to_vec(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

/// Triangles that meet at less than this angle are shaded as one round surface.
constexpr float kCreaseCosine = 0.75f;

/// Corners are shared where the triangles around a position turn little.
class MeshMaker {
 public:
  explicit MeshMaker(const Model& m) : model_(m), first_(m.positions.size(), kNone) {}

  Mesh make() {
    for (const auto& t : model_.triangles) {
      Vec p[3];
      for (int k = 0; k < 3; ++k) p[k] = to_vec(model_.positions[t.corners[k]]);
      const Vec n = cross(p[1] - p[0], p[2] - p[0]);
      if (model_.materials[t.material].opacity < 0.5f || !(length(n) > 1e-10f)) continue;
      Face face{{}, t.material};
      for (int k = 0; k < 3; ++k) face.corners[k] = corner(t.corners[k], n);
      mesh_.faces.push_back(face);
    }
    for (Corner& c : mesh_.corners) c.normal = normalized(c.normal);
    return std::move(mesh_);
  }

 private:
  /// The corner at this position whose triangles face the same way, or a new one. Normals add up,
  /// weighted by area.
  std::uint32_t corner(std::uint32_t position, Vec n) {
    const Vec facing = normalized(n);
    std::uint32_t* last = &first_[position];
    for (; *last != kNone; last = &next_[*last]) {
      Vec& normal = mesh_.corners[*last].normal;
      if (dot(normalized(normal), facing) < kCreaseCosine) continue;
      normal += n;
      return *last;
    }
    const Vec p = to_vec(model_.positions[position]);
    const std::array<float, 2> uv =
        model_.uvs.empty() ? std::array<float, 2>{p.x, p.y} : model_.uvs[position];
    const auto fresh = static_cast<std::uint32_t>(mesh_.corners.size());
    *last = fresh;  // before next_ grows
    next_.push_back(kNone);
    mesh_.corners.push_back({p, n, uv[0], uv[1]});
    return fresh;
  }

  static constexpr std::uint32_t kNone = 0xffffffff;

  const Model& model_;
  Mesh mesh_;
  std::vector<std::uint32_t> first_;  ///< corner at each position
  std::vector<std::uint32_t> next_;   ///< corner at the same position, of each corner
};

/// Whether the name has this word, or a plural of it.
bool has_word(const std::string& name, const std::string& word) {
  for (std::size_t at = name.find(word); at != std::string::npos; at = name.find(word, at + 1)) {
    std::size_t end = at + word.size();
    if (end < name.size() && name[end] == 's') ++end;
    const auto letter = [&](std::size_t i) {
      return i < name.size() && std::isalpha(static_cast<unsigned char>(name[i]));
    };
    if ((at == 0 || !letter(at - 1)) && !letter(end)) return true;
  }
  return false;
}

Role role_of(const Model& m, const Vec& size) {
  std::string name;
  for (const char c : m.name)
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto any = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* w) { return has_word(name, w); });
  };
  if (m.door_or_window) return Role::door;
  if (any({"sofa", "couch", "armchair"})) return Role::couch;
  if (any({"chair", "stool", "seat", "bench"})) return Role::seat;
  if (any({"bed", "futon"}) && size.x > 0.7f && size.z > 1.2f) return Role::bed;
  if (any({"shelves", "bookcase", "cabinet", "cupboard", "wardrobe", "dresser", "locker", "chest",
           "drawers", "stand"})) {
    return Role::storage;
  }
  if (any({"table", "desk", "workbench"}) && size.y > 0.3f && size.x > 0.4f) return Role::table;
  if (any({"plant", "ficus", "yucca", "bamboo", "cactus", "tree", "orchid"})) return Role::plant;
  return Role::other;
}

Use use_of(const Model& m, const Vec& size) {
  const float widest = std::max(size.x, size.z);
  const auto is = [&](const char* category) { return m.category == category; };
  if (widest > 2.9f || size.y > 2.5f || widest < 0.02f || is("Staircases")) return Use::none;
  if (m.door_or_window) return m.elevation < 0.05f && size.z < 0.3f ? Use::floor : Use::none;
  if (m.elevation > 2) return Use::ceiling;
  if (m.elevation > 0.1f) return size.z < 0.6f ? Use::wall : Use::none;
  if (widest < 0.55f && size.y < 0.6f) return Use::top;
  if ((is("Exterior") || is("Vehicles")) && (widest > 1.9f || size.y > 1.5f)) return Use::none;
  return size.y > 0.15f ? Use::floor : Use::none;
}

/// Whether most of the model, seen from above, is flat at its very top.
bool has_flat_top(const StoredModel& s) {
  float area = 0;
  for (const Face& f : s.mesh.faces) {
    Vec p[3];
    for (int k = 0; k < 3; ++k) p[k] = s.mesh.corners[f.corners[k]].position;
    if (std::min(p[0].y, std::min(p[1].y, p[2].y)) < s.high.y - 0.02f) continue;
    area += 0.5f * std::abs(cross(p[1] - p[0], p[2] - p[0]).y);
  }
  return area > 0.75f * s.size().x * s.size().z;
}

StoredModel to_stored(const Model& m) {
  StoredModel s;
  s.mesh = MeshMaker(m).make();
  if (s.mesh.faces.empty()) return s;
  s.name = m.name;
  s.category = m.category;
  s.elevation = m.elevation;
  s.low = s.high = s.mesh.corners[0].position;
  for (const Corner& c : s.mesh.corners) {
    s.low = min(s.low, c.position);
    s.high = max(s.high, c.position);
  }
  s.role = role_of(m, s.size());
  s.use = use_of(m, s.size());
  s.flat_top = has_flat_top(s);
  for (const auto& material : m.materials) s.materials.push_back(to_material(material));
  for (const auto& texture : m.textures) s.pictures.emplace_back(texture);
  return s;
}

}  // namespace

Furniture::Furniture(const std::vector<Model>& models) {
  std::vector<StoredModel> stored(models.size());
  parallel_for(models.size(), [&](std::size_t i) {
    check(models[i]);
    stored[i] = to_stored(models[i]);
  });
  auto store = std::make_shared<FurnitureStore>();
  for (StoredModel& s : stored) {
    if (s.mesh.faces.empty()) continue;
    const int index = static_cast<int>(store->models.size());
    if (s.use == Use::floor) store->on_floor[static_cast<int>(s.role)].push_back(index);
    if (s.use == Use::top) store->on_top.push_back(index);
    if (s.use == Use::wall) store->on_wall.push_back(index);
    if (s.use == Use::ceiling) store->on_ceiling.push_back(index);
    store->models.push_back(std::move(s));
  }
  store_ = std::move(store);
}

const Tree& StoredModel::tree() const {
  std::call_once(late_->once, [&] { late_->tree = Tree(mesh); });
  return late_->tree;
}

std::size_t Furniture::size() const { return store_->models.size(); }

}  // namespace ps::rooms
