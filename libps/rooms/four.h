// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: a Vec in a register of four floats, which every machine has.
#pragma once

#include "libps/rooms/vec.h"

namespace ps::rooms {

typedef float Four __attribute__((vector_size(16)));

inline Four four(Vec v) { return Four{v.x, v.y, v.z, 0}; }
inline Four four(float x) { return Four{x, x, x, x}; }
inline Vec vec(Four v) { return {v[0], v[1], v[2]}; }
inline Four min(Four a, Four b) { return b < a ? b : a; }
inline Four max(Four a, Four b) { return a < b ? b : a; }

}  // namespace ps::rooms
