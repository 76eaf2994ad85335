// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include "libps/rooms/pieces.h"

namespace ps::rooms {

/// The smallest upright rectangle around a turned one.
Rect bounds_of(const Frame& f, float width, float depth);

/// Finds free places in a space and puts things there.
class Placer {
 public:
  Placer(Set& set, const Plan& plan);

 protected:
  /// @return true if nothing stands there and it is within one rectangle of the floor
  bool free(const Rect& r, float low, float high) const;
  /// @return true if a part of a wall has a door or window behind these heights
  bool covers(const Edge& e, float x, float width, float low, float high) const;
  void draw(const Piece& p, const Frame& f);
  /// Notes that the floor is taken.
  void stand(const Rect& r, float height);
  /// With its back against a wall. @return false if there is no place
  bool wall(const Piece& p);
  /// Anywhere on the floor.
  bool loose(const Piece& p);
  /// On a wall, its lower edge between these heights.
  bool hang(const Piece& p, float low, float high);

  Set& set_;
  const Plan& plan_;
  Dice d_;
};

}  // namespace ps::rooms
