// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/furniture.h"

#include <cmath>
#include <string>

#include "libps/core/error.h"
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

/// Corners of triangles, each with its own normal.
Mesh to_mesh(const Model& m) {
  Mesh mesh;
  for (const auto& t : m.triangles) {
    if (m.materials[t.material].opacity < 0.5f) continue;
    Vec p[3];
    for (int k = 0; k < 3; ++k) p[k] = to_vec(m.positions[t.corners[k]]);
    const Vec n = cross(p[1] - p[0], p[2] - p[0]);
    if (!(length(n) > 1e-10f)) continue;
    const auto first = static_cast<std::uint32_t>(mesh.corners.size());
    for (int k = 0; k < 3; ++k) {
      const std::array<float, 2> uv =
          m.uvs.empty() ? std::array<float, 2>{p[k].x, p[k].y} : m.uvs[t.corners[k]];
      mesh.corners.push_back({p[k], normalized(n), uv[0], uv[1]});
    }
    mesh.faces.push_back({{first, first + 1, first + 2}, t.material});
  }
  return mesh;
}

}  // namespace

Furniture::Furniture(const std::vector<Model>& models) {
  auto store = std::make_shared<FurnitureStore>();
  for (const Model& m : models) {
    check(m);
    StoredModel s;
    s.mesh = to_mesh(m);
    if (s.mesh.faces.empty()) continue;
    s.name = m.name;
    s.category = m.category;
    s.elevation = m.elevation;
    s.door_or_window = m.door_or_window;
    s.low = s.high = s.mesh.corners[0].position;
    for (const Corner& c : s.mesh.corners) {
      s.low = min(s.low, c.position);
      s.high = max(s.high, c.position);
    }
    s.tree = Tree(s.mesh);
    for (const auto& material : m.materials) s.materials.push_back(to_material(material));
    for (const auto& texture : m.textures) s.pictures.emplace_back(texture);
    store->models.push_back(std::move(s));
  }
  store_ = std::move(store);
}

std::size_t Furniture::size() const { return store_->models.size(); }

}  // namespace ps::rooms
