// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set (PS_ISA). C headers only: nothing inline may be shared.
// Loops over the rays of a packet are left to the compiler to turn into vectors.
#include "libps/rooms/trace_kernel.h"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#define PS_JOIN2(a, b) a##b
#define PS_JOIN(a, b) PS_JOIN2(a, b)

namespace ps {
namespace rooms {
namespace trace_kernel {
namespace {

/// A surface does not shade itself, and a crack between triangles is closed.
constexpr float kNear = 1e-5f, kOutside = -1e-5f;

inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }

/// @return whether any a is at most its b
inline bool any_at_most(const float* a, const float* b) {
#if defined(__AVX512F__)
  return _mm512_cmp_ps_mask(_mm512_load_ps(a), _mm512_load_ps(b), _CMP_LE_OQ) != 0;
#elif defined(__AVX2__)
  const __m256 low = _mm256_cmp_ps(_mm256_load_ps(a), _mm256_load_ps(b), _CMP_LE_OQ);
  const __m256 high = _mm256_cmp_ps(_mm256_load_ps(a + 8), _mm256_load_ps(b + 8), _CMP_LE_OQ);
  return _mm256_movemask_ps(_mm256_or_ps(low, high)) != 0;
#else
  int any = 0;
  for (int i = 0; i < kRays; ++i) any |= a[i] <= b[i] ? 1 : 0;
  return any != 0;
#endif
}

inline bool meets_box(const TraceNode& n, const Rays& r) {
  alignas(64) float in[kRays], out[kRays];
  for (int i = 0; i < kRays; ++i) {
    const float ax = (n.low[0] - r.origin[0][i]) * r.inverse[0][i];
    const float bx = (n.high[0] - r.origin[0][i]) * r.inverse[0][i];
    const float ay = (n.low[1] - r.origin[1][i]) * r.inverse[1][i];
    const float by = (n.high[1] - r.origin[1][i]) * r.inverse[1][i];
    const float az = (n.low[2] - r.origin[2][i]) * r.inverse[2][i];
    const float bz = (n.high[2] - r.origin[2][i]) * r.inverse[2][i];
    in[i] = larger(larger(smaller(ax, bx), smaller(ay, by)), larger(smaller(az, bz), 0.f));
    out[i] = smaller(smaller(larger(ax, bx), larger(ay, by)), smaller(larger(az, bz), r.reach[i]));
  }
  return any_at_most(in, out);
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
  const int first = lead(*rays);
  if (first < 0) return;
  uint32_t stack[64];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const TraceNode& node = nodes[stack[--size]];
    if (!meets_box(node, *rays)) continue;
    if (node.count > 0) {
      for (uint32_t t = node.first; t < node.first + node.count; ++t) {
        keep_nearest(triangles[t], part, rays);
      }
    } else {
      const uint32_t swap = rays->direction[node.axis][first] > 0 ? 0 : 1;
      stack[size++] = node.first + 1 - swap;
      stack[size++] = node.first + swap;
    }
  }
}

void PS_JOIN(blocked_, PS_ISA)(const TraceNode* nodes, const TraceTriangle* triangles, Rays* rays) {
  const int first = lead(*rays);
  if (first < 0) return;
  uint32_t stack[64];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const TraceNode& node = nodes[stack[--size]];
    if (!meets_box(node, *rays)) continue;
    if (node.count > 0) {
      for (uint32_t t = node.first; t < node.first + node.count; ++t) {
        if (!stop_blocked(triangles[t], rays)) return;
      }
    } else {
      const uint32_t swap = rays->direction[node.axis][first] > 0 ? 0 : 1;
      stack[size++] = node.first + 1 - swap;
      stack[size++] = node.first + swap;
    }
  }
}

int PS_JOIN(reached_, PS_ISA)(const TraceNode* nodes, const TraceTriangle* triangles,
                              const Rays* rays, uint32_t* out) {
  const int first = lead(*rays);
  if (first < 0) return 0;
  uint32_t stack[64];
  int size = 0, count = 0;
  stack[size++] = 0;
  while (size > 0) {
    const TraceNode& node = nodes[stack[--size]];
    if (!meets_box(node, *rays)) continue;
    if (node.count > 0) {
      for (uint32_t t = node.first; t < node.first + node.count; ++t)
        out[count++] = triangles[t].face;
    } else {
      const uint32_t swap = rays->direction[node.axis][first] > 0 ? 0 : 1;
      stack[size++] = node.first + 1 - swap;
      stack[size++] = node.first + swap;
    }
  }
  return count;
}

}  // namespace trace_kernel
}  // namespace rooms
}  // namespace ps
