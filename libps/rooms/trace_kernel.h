// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: rays against a tree of triangles, built for several vector widths.
#pragma once

#include <stdint.h>

namespace ps {
namespace rooms {

constexpr int kRays = 16;  ///< rays of a packet

struct TraceNode {
  float low[3], high[3];
  uint32_t first;  ///< leaf: first triangle; inner: first child, the second follows it
  uint16_t count;  ///< triangles of a leaf; 0 = inner
  uint16_t axis;   ///< along which the children are apart
};

struct TraceTriangle {
  float corner[3], edge1[3], edge2[3];
  uint32_t face;  ///< index in the mesh
};

/// Rays o + t d; d need not be of length 1. A hit is kept where t is less than `reach`.
struct alignas(64) Rays {
  float origin[3][kRays], direction[3][kRays], inverse[3][kRays];
  float reach[kRays];  ///< negative = no ray; then the t of the hit
  float u[kRays], v[kRays];
  int32_t face[kRays];  ///< -1 = no hit
  int32_t part[kRays];  ///< which tree was hit
};

namespace trace_kernel {

/// Nearest hits in one tree; `part` is noted where this tree is hit.
typedef void Nearest(const TraceNode* nodes, const TraceTriangle* triangles, int part, Rays* rays);
/// Sets `reach` to -1 for each ray that hits anything.
typedef void Blocked(const TraceNode* nodes, const TraceTriangle* triangles, Rays* rays);

/// Writes the `face` of each triangle whose leaf any ray may reach, nearer ones mostly first: a
/// tree of boxes, whose triangles say which box. @return how many
typedef int Reached(const TraceNode* nodes, const TraceTriangle* triangles, const Rays* rays,
                    uint32_t* out);

/// A frame of axes at right angles, perhaps longer than 1.
struct Axes {
  float axis[3][3], square[3];  ///< square: of each axis's length
  float origin[3];
};
/// The packet in that frame.
typedef void Enter(const Axes& axes, const Rays& rays, Rays& local);

Enter enter_baseline, enter_avx2, enter_avx512;
Nearest nearest_baseline, nearest_avx2, nearest_avx512;
Blocked blocked_baseline, blocked_avx2, blocked_avx512;
Reached reached_baseline, reached_avx2, reached_avx512;

}  // namespace trace_kernel
}  // namespace rooms
}  // namespace ps
