// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: procedural furniture.
#pragma once

#include <functional>

#include "libps/rooms/set.h"

namespace ps::rooms {

/// Furniture that is decided upon but not yet placed. It stands on y = 0 about the origin, its
/// back at z = -size.z / 2, its front towards z.
struct Piece {
  Vec size;  ///< width, height, depth, metres
  std::function<void(Set&, Builder)> draw;
};

// pieces_seats.cpp
Piece chair(Set& set, Dice& d);
Piece office_chair(Set& set, Dice& d);
Piece stool(Set& set, Dice& d);
Piece sofa(Set& set, Dice& d, bool single);
Piece bed(Set& set, Dice& d);

// pieces_cases.cpp
Piece table(Set& set, Dice& d, bool low);
Piece round_table(Set& set, Dice& d);
Piece desk(Set& set, Dice& d);
Piece shelf(Set& set, Dice& d);
Piece cupboard(Set& set, Dice& d, float low, float high);  ///< heights to choose from

// pieces_kitchen.cpp
/// Notes a free place for clutter, in the frame of a piece.
void add_top(Set& set, const Builder& b, Vec middle, float width, float depth, float room);
/// Doors and drawers over (x0, y0)-(x1, y1) of the plane z = 0.
void fronts(Builder b, Dice& d, float x0, float y0, float x1, float y1, int style, int front,
            int grip);
Piece kitchen_row(Set& set, Dice& d, float width);
Piece fridge(Set& set, Dice& d);
Piece counter(Set& set, Dice& d);

// pieces_large.cpp
/// Posts and rails from floor to ceiling or less, glass between them that nobody sees.
Piece partition(Set& set, Dice& d, float height);
Piece stairs(Set& set, Dice& d, float height);
Piece piano(Set& set, Dice& d);
Piece table_game(Set& set, Dice& d);
Piece easel(Set& set, Dice& d);
Piece locker_row(Set& set, Dice& d);

// pieces_models.cpp: real models, where the scene has a store of them
/// @return true if there are models and the dice are for one
bool wants_model(const Set& set, Dice& d);
/// A model of this role, or the procedural piece. Mostly one that suits the kind of room.
Piece model_or(Set& set, Dice& d, Role role, RoomKind kind, Piece otherwise);
/// A model for a wall or ceiling and the height it wants; nothing to draw if there is none.
Piece hanging_model(Set& set, Dice& d, bool ceiling, float& elevation);
/// @return false if none of a few that were tried fits
bool model_clutter(Set& set, Dice& d, const Frame& f, float width, float depth, float height);

// pieces_plants.cpp
Piece plant(Set& set, Dice& d);
/// Materials: those of a plant's pot, soil, leaves and stems.
void draw_plant(Dice& d, Builder b, float height, float radius, int pot, int soil, int leaf,
                int stem);
/// A material for leaves.
int green(Set& set, Dice& d);

// pieces_small.cpp
Piece floor_lamp(Set& set, Dice& d);
Piece bin(Set& set, Dice& d);
Piece box_pile(Set& set, Dice& d);
Piece toilet(Set& set, Dice& d);
Piece bathtub(Set& set, Dice& d);
Piece basin(Set& set, Dice& d);
Piece stepladder(Set& set, Dice& d);
Piece bag(Set& set, Dice& d);

// clutter.cpp
/// One thing that stands on a table or shelf, at most this large.
void clutter(Set& set, Dice& d, Builder b, float width, float depth, float height);
/// Fills a top with things; `fill` of 1 is crowded.
void strew(Set& set, Dice& d, const Top& top, float fill);

// pieces_wall.cpp: things on a wall, drawn at (0, 0, 0), growing along z.
Piece wall_picture(Set& set, Dice& d);
Piece wall_board(Set& set, Dice& d);
Piece wall_screen(Set& set, Dice& d);
Piece wall_shelf(Set& set, Dice& d);
Piece wall_mirror(Set& set, Dice& d);
Piece wall_clock(Set& set, Dice& d);
Piece coat_rack(Set& set, Dice& d);
Piece wall_socket(Set& set, Dice& d);

}  // namespace ps::rooms
