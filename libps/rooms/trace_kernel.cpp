// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set (PS_ISA). C headers only: nothing inline may be shared.
// Loops over the rays of a packet are left to the compiler to turn into vectors.
#include "libps/rooms/trace_kernel.h"

#include "libps/rooms/lanes.h"

#define PS_JOIN2(a, b) a##b
#define PS_JOIN(a, b) PS_JOIN2(a, b)

namespace ps {
namespace rooms {
namespace trace_kernel {
namespace {

/// A surface does not shade itself, and a crack between triangles is closed.
constexpr float kNear = 1e-5f, kOutside = -1e-5f;

constexpr int kParts = kRays / kLanes;  ///< vectors of a packet

/// Where each ray comes into a box and leaves it.
struct Span {
  Lanes in[kParts], out[kParts];

  bool met() const {
    bool any = false;
    for (int p = 0; p < kParts; ++p) any |= any_at_most(in[p], out[p]);
    return any;
  }
};

inline Span cross_box(const TraceNode& n, const Rays& r) {
  Span s;
  for (int p = 0; p < kParts; ++p) {
    const int i = p * kLanes;
    const Lanes ox = load(r.origin[0] + i), oy = load(r.origin[1] + i), oz = load(r.origin[2] + i);
    const Lanes ix = load(r.inverse[0] + i), iy = load(r.inverse[1] + i),
                iz = load(r.inverse[2] + i);
    const Lanes ax = (n.low[0] - ox) * ix, bx = (n.high[0] - ox) * ix;
    const Lanes ay = (n.low[1] - oy) * iy, by = (n.high[1] - oy) * iy;
    const Lanes az = (n.low[2] - oz) * iz, bz = (n.high[2] - oz) * iz;
    s.in[p] = larger(larger(smaller(ax, bx), smaller(ay, by)), larger(smaller(az, bz), Lanes{}));
    s.out[p] = smaller(smaller(larger(ax, bx), larger(ay, by)),
                       smaller(larger(az, bz), load(r.reach + i)));
  }
  return s;
}

/// Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
struct Hit {
  float t, u, v;
  int yes;
};

inline Hit meet(const TraceTriangle& q, const Rays& r, int i) {
  const float dx = r.direction[0][i], dy = r.direction[1][i], dz = r.direction[2][i];
  const float px = dy * q.edge2[2] - dz * q.edge2[1];
  const float py = dz * q.edge2[0] - dx * q.edge2[2];
  const float pz = dx * q.edge2[1] - dy * q.edge2[0];
  const float det = q.edge1[0] * px + q.edge1[1] * py + q.edge1[2] * pz;
  const float inverse = 1 / det;  // parallel: no comparison below holds
  const float sx = r.origin[0][i] - q.corner[0], sy = r.origin[1][i] - q.corner[1],
              sz = r.origin[2][i] - q.corner[2];
  const float qx = sy * q.edge1[2] - sz * q.edge1[1];
  const float qy = sz * q.edge1[0] - sx * q.edge1[2];
  const float qz = sx * q.edge1[1] - sy * q.edge1[0];
  Hit hit;
  hit.u = (sx * px + sy * py + sz * pz) * inverse;
  hit.v = (dx * qx + dy * qy + dz * qz) * inverse;
  hit.t = (q.edge2[0] * qx + q.edge2[1] * qy + q.edge2[2] * qz) * inverse;
  hit.yes = (hit.u >= kOutside) & (hit.v >= kOutside) & (hit.u + hit.v <= 1 - kOutside) &
            (hit.t > kNear) & (hit.t < r.reach[i]);
  return hit;
}

inline void keep_nearest(const TraceTriangle& q, int part, Rays* r) {
  const int face = static_cast<int>(q.face);
  for (int i = 0; i < kRays; ++i) {
    const Hit hit = meet(q, *r, i);
    r->reach[i] = hit.yes ? hit.t : r->reach[i];
    r->u[i] = hit.yes ? hit.u : r->u[i];
    r->v[i] = hit.yes ? hit.v : r->v[i];
    r->face[i] = hit.yes ? face : r->face[i];
    r->part[i] = hit.yes ? part : r->part[i];
  }
}

/// @return false when no ray is left
inline bool stop_blocked(const TraceTriangle& q, Rays* r) {
  for (int i = 0; i < kRays; ++i) {
    const Hit hit = meet(q, *r, i);
    r->reach[i] = hit.yes ? -1.f : r->reach[i];
  }
  int left = 0;
  for (int i = 0; i < kRays; ++i) left |= r->reach[i] > 0 ? 1 : 0;
  return left != 0;
}

inline int lead(const Rays& r) {
  for (int i = 0; i < kRays; ++i) {
    if (r.reach[i] > 0) return i;
  }
  return -1;
}

/// Boxes that were met and wait, and where each ray comes into them.
struct Waiting {
  static constexpr int kMost = 64;
  static constexpr float kNever = 3e38f;

  Lanes in[kMost][kParts];
  uint32_t node[kMost];
  int count;

  void push(uint32_t which, const Span& s) {
    for (int p = 0; p < kParts; ++p) {
      in[count][p] = s.in[p] <= s.out[p] ? s.in[p] : all_lanes(kNever);
    }
    node[count++] = which;
  }
  /// @return false when no box is left that a ray still reaches
  bool pop(const Rays& r, uint32_t& which) {
    while (count > 0) {
      which = node[--count];
      for (int p = 0; p < kParts; ++p) {
        if (any_at_most(in[count][p], load(r.reach + p * kLanes))) return true;
      }
    }
    return false;
  }
};

/// Visits the leaves that the rays may reach, nearer ones mostly first, both children of a node at
/// once.
/// @param leaf  (node) -> false to stop
template <typename Leaf>
inline void walk(const TraceNode* nodes, const Rays& rays, const Leaf& leaf) {
  const int first = lead(rays);
  if (first < 0) return;
  if (!cross_box(nodes[0], rays).met()) return;
  Waiting waiting;
  waiting.count = 0;
  uint32_t at = 0;
  for (;;) {
    const TraceNode& node = nodes[at];
    if (node.count > 0) {
      if (!leaf(node) || !waiting.pop(rays, at)) return;
      continue;
    }
    const uint32_t swap = rays.direction[node.axis][first] > 0 ? 0 : 1;
    const uint32_t nearer = node.first + swap, further = node.first + 1 - swap;
    const Span near = cross_box(nodes[nearer], rays), far = cross_box(nodes[further], rays);
    const bool meets_far = far.met();
    if (near.met()) {
      if (meets_far) waiting.push(further, far);
      at = nearer;
    } else if (meets_far) {
      at = further;
    } else if (!waiting.pop(rays, at)) {
      return;
    }
  }
}

/// Directions that are nearly 0 along an axis run along it, very far.
inline float inverse_of(float d) {
  const float size = d < 0 ? -d : d;
  return 1 / (size > 1e-12f ? d : 1e-12f);
}

}  // namespace

void PS_JOIN(enter_, PS_ISA)(const Axes& f, const Rays& rays, Rays& local) {
  for (int i = 0; i < kRays; ++i) {
    const float x = rays.origin[0][i] - f.origin[0], y = rays.origin[1][i] - f.origin[1],
                z = rays.origin[2][i] - f.origin[2];
    const float dx = rays.direction[0][i], dy = rays.direction[1][i], dz = rays.direction[2][i];
    for (int a = 0; a < 3; ++a) {
      const float* e = f.axis[a];
      local.origin[a][i] = (x * e[0] + y * e[1] + z * e[2]) / f.square[a];
      const float d = (dx * e[0] + dy * e[1] + dz * e[2]) / f.square[a];
      local.direction[a][i] = d;
      local.inverse[a][i] = inverse_of(d);
    }
    local.reach[i] = rays.reach[i] > 0 ? rays.reach[i] : -1.f;
    local.u[i] = local.v[i] = 0;
    local.face[i] = local.part[i] = -1;
  }
}

void PS_JOIN(nearest_, PS_ISA)(const TraceNode* nodes, const TraceTriangle* triangles, int part,
                               Rays* rays) {
  walk(nodes, *rays, [&](const TraceNode& node) {
    for (uint32_t t = node.first; t < node.first + node.count; ++t) {
      keep_nearest(triangles[t], part, rays);
    }
    return true;
  });
}

void PS_JOIN(blocked_, PS_ISA)(const TraceNode* nodes, const TraceTriangle* triangles, Rays* rays) {
  walk(nodes, *rays, [&](const TraceNode& node) {
    for (uint32_t t = node.first; t < node.first + node.count; ++t) {
      if (!stop_blocked(triangles[t], rays)) return false;
    }
    return true;
  });
}

int PS_JOIN(reached_, PS_ISA)(const TraceNode* nodes, const TraceTriangle* triangles,
                              const Rays* rays, uint32_t* out) {
  int count = 0;
  walk(nodes, *rays, [&](const TraceNode& node) {
    for (uint32_t t = node.first; t < node.first + node.count; ++t)
      out[count++] = triangles[t].face;
    return true;
  });
  return count;
}

}  // namespace trace_kernel
}  // namespace rooms
}  // namespace ps
