// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: the parts of a room's shell.
#pragma once

#include "libps/rooms/set.h"

namespace ps::rooms {

// openings.cpp
void build_door(Set& set, Dice& d, const Edge& e, const Opening& o);
/// @param curtain  material, -1 = none
void build_window(Set& set, Dice& d, const Edge& e, const Opening& o, int curtain, bool blinds);
void build_radiator(Set& set, Dice& d, const Edge& e, const Opening& o);
/// The light that comes through the windows of a wall.
void light_windows(Set& set, const Edge& e);

// ceilings.cpp
/// Lamps on the ceiling; `on` or not.
void light_ceiling(Set& set, Dice& d, const Plan& plan, bool on);
void build_beams(Set& set, Dice& d, const Plan& plan);
/// Pipes, ducts or rails below the ceiling.
void build_ducts(Set& set, Dice& d, const Plan& plan);

}  // namespace ps::rooms
