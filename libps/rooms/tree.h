// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <vector>

#include "libps/rooms/mesh.h"
#include "libps/rooms/trace_kernel.h"

namespace ps::rooms {

/// The triangles of a mesh, sorted for rays: a binary tree of boxes by the surface area heuristic
/// (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007).
struct Tree {
  /// Two that are looked at together, in one line of the cache.
  struct alignas(64) Pair {
    TraceNode nodes[2];
  };
  std::vector<Pair> pairs;  ///< the root, alone, then children; none for an empty mesh
  std::vector<TraceTriangle> triangles;

  Tree() = default;
  explicit Tree(const Mesh& mesh);
  /// A tree of boxes (low, high), for reached().
  explicit Tree(const std::vector<std::array<Vec, 2>>& boxes);

  bool empty() const { return pairs.empty(); }
  /// @return as kernels take nodes: child 2 i + k is node k of pair i
  const TraceNode* root() const { return pairs.data()->nodes; }
};

/// Empties the packet: no rays.
inline void clear(Rays& rays) {
  for (int i = 0; i < kRays; ++i) {
    rays.reach[i] = -1;
    rays.face[i] = rays.part[i] = -1;
    rays.u[i] = rays.v[i] = 0;
    for (int a = 0; a < 3; ++a) {
      rays.origin[a][i] = 0;
      rays.direction[a][i] = rays.inverse[a][i] = 1;
    }
  }
}

/// Sets ray i: origin + t direction for t in (0, reach).
inline void set_ray(Rays& rays, int i, Vec origin, Vec direction, float reach) {
  const float o[3] = {origin.x, origin.y, origin.z};
  const float d[3] = {direction.x, direction.y, direction.z};
  for (int a = 0; a < 3; ++a) {
    rays.origin[a][i] = o[a];
    rays.direction[a][i] = d[a];
    rays.inverse[a][i] = 1 / (std::abs(d[a]) > 1e-12f ? d[a] : 1e-12f);
  }
  rays.reach[i] = reach;
  rays.face[i] = rays.part[i] = -1;
}

/// The packet in the frame of a part.
void enter(const trace_kernel::Axes& axes, const Rays& rays, Rays& local);
/// See trace_kernel.h; nothing happens for an empty tree.
void nearest(const Tree& tree, int part, Rays& rays);
void blocked(const Tree& tree, Rays& rays);
/// @param out  room for as many as there are boxes
/// @return how many boxes of the tree the rays may reach
int reached(const Tree& tree, const Rays& rays, std::uint32_t* out);

}  // namespace ps::rooms
