// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libps/rooms/four.h"
#include "libps/rooms/furniture_store.h"
#include "libps/rooms/light_kernel.h"
#include "libps/rooms/mesh.h"
#include "libps/rooms/room.h"
#include "libps/rooms/tree.h"

namespace ps::rooms {

/// A rectangle of floor, metres.
struct Rect {
  float x0 = 0, z0 = 0, x1 = 0, z1 = 0;

  bool holds(float x, float z) const { return x > x0 && x < x1 && z > z0 && z < z1; }
  bool meets(const Rect& r) const { return x0 < r.x1 && r.x0 < x1 && z0 < r.z1 && r.z0 < z1; }
  Rect grown(float by) const { return {x0 - by, z0 - by, x1 + by, z1 + by}; }
  float width() const { return x1 - x0; }
  float depth() const { return z1 - z0; }
};

/// A flat or, if round, a ball-shaped light.
struct Emitter {
  Vec center, half_u, half_v, normal;
  bool round = false;  ///< half_u.x is the radius
  float area = 0;      ///< as seen head on
  float radius = 0;    ///< of a ball around it
};

constexpr std::size_t kMostEmitters = 48;  ///< of a group
constexpr std::size_t kMostLights = 32;    ///< groups of a scene, a bit for each

/// Lights of one radiance that are sampled together.
struct LightGroup {
  std::vector<Emitter> emitters;
  std::vector<light_kernel::Lamp> lamps;  ///< the emitters as they are weighed
  Vec radiance;
  Vec middle;
  float area = 0;  ///< of all

  /// Sets the emitter's area and radius. More than kMostEmitters are left out.
  void add(Emitter e);
};

struct Sky {
  Vec zenith, horizon, ground, walls, leaves;
  float skyline = 0.2f;  ///< slope up to which houses stand
  std::uint32_t seed = 0;
  Vec sun_direction;   ///< towards the sun
  Vec sun_irradiance;  ///< 0 = none

  Vec radiance(Vec direction) const;
};

/// Light that arrives from all around, on a grid: irradiance on the six faces of a cube.
struct Probes {
  Vec low, step;
  int nx = 0, ny = 0, nz = 0;
  std::vector<std::array<Four, 6>> cubes;

  Vec irradiance(Vec position, Vec normal) const;
};

/// One room of the building: the main one is the first.
struct Space {
  RoomKind kind = RoomKind::office;
  std::vector<Rect> rects;  ///< its floor
  float height = 2.5f;
  Vec low, high;
  Probes probes;
  std::uint32_t lit_by = 0;  ///< a bit for each group of lights
  bool sunny = false;

  bool holds(Vec p, float grow = 0) const;
};

/// A mesh where it stands.
struct Part {
  const Mesh* mesh = nullptr;
  const Tree* tree = nullptr;
  const std::vector<Material>* materials = nullptr;
  const std::vector<Picture>* pictures = nullptr;
  bool placed = false;  ///< `world` is not the identity
  Frame world;          ///< axes at right angles, perhaps longer than 1
  Vec low, high;        ///< bounds in the world
  bool casts = true;    ///< shadows
};

constexpr std::size_t kMostParts = 256;

struct Scene {
  Mesh solid, lamps;  ///< lamps cast no shadow
  Tree solid_tree, lamp_tree;
  std::vector<Material> materials;
  std::vector<Picture> pictures;
  std::vector<Part> parts;  ///< the two above, then placed models
  Tree part_tree;           ///< boxes of placed models
  std::vector<Space> spaces;
  std::vector<LightGroup> lights;
  std::shared_ptr<const FurnitureStore> furniture;
  Sky sky;
  float exposure = 1;
  float key = 0.12f;       ///< how bright the middle of a room is shown, linear
  float middle_light = 1;  ///< irradiance / pi that is left as it is: cameras lift what is darker
  float evening = 0.35f;   ///< by this power of the ratio

  /// Light as the camera evens it out, from irradiance / pi. A function of the place alone, so that
  /// views agree.
  Vec evened(Vec light) const;
  bool mirrors = false;
  std::vector<std::array<Vec, 2>> things;  ///< bounds of what nobody can be inside of

  /// @return true inside the bounds of a piece of furniture
  bool inside_thing(Vec p) const;
  void nearest(Rays& rays) const;
  void blocked(Rays& rays) const;
  /// @return the space at this place, or the nearest one
  const Space& space_at(Vec p) const;
};

/// What a ray meets.
struct Surface {
  Vec position;
  Vec flat;    ///< normal of the triangle, towards the ray's origin
  Vec normal;  ///< shading's, towards the ray's origin
  const Material* material = nullptr;
  const std::vector<Picture>* pictures = nullptr;
  float u = 0, v = 0;
  float uv_per_metre = 1;
  bool from_behind = false;
};

/// @return the surface that ray i hit; `face` must not be -1
Surface surface_of(const Scene& scene, const Rays& rays, int i);

/// Builds the whole scene but for its trees, probes and exposure.
void furnish(Scene& scene, std::uint64_t seed, const RoomOptions& options);

}  // namespace ps::rooms
