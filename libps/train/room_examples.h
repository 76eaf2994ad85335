// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "libps/rooms/room.h"
#include "libps/train/examples.h"

namespace ps::train {

/// @brief Pairs of views of one room: the second turned by up to 0.75 rad and moved by up to 0.6 m,
/// one time in three only turned; both as a camera would show them.
std::vector<ExamplePair> room_pairs(std::uint64_t seed, const rooms::RoomOptions& options,
                                    int count);

}  // namespace ps::train
