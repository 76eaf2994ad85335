// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: what is at hand while a scene is built.
#pragma once

#include <vector>

#include "libps/rooms/builder.h"
#include "libps/rooms/dice.h"
#include "libps/rooms/scene.h"

namespace ps::rooms {

/// Where something stands: nothing else may stand there at these heights.
struct Footprint {
  Rect rect;
  float low = 0, high = 2.5f;
};

/// A free flat place that clutter can stand on: x right, z towards the front, from its middle.
struct Top {
  Frame frame;
  float width = 0, depth = 0;
  float room = 0.4f;  ///< free height
};

struct Opening {
  enum Kind { window, closed_door, open_door, archway } kind = window;
  float from = 0, to = 0;  ///< metres along the edge
  float bottom = 0, top = 2;
  bool behind = false;  ///< the other side of an opening that is built already
};

/// A stretch of wall, from p along x of its frame; z points into the room.
struct Edge {
  Frame frame;
  float length = 0;
  std::vector<Opening> openings;
  int material = 0;
};

/// A space while it is built.
struct Plan {
  int space = 0;  ///< index in Scene::spaces
  RoomKind kind = RoomKind::office;
  std::vector<Rect> rects;
  float height = 2.5f;
  std::vector<Edge> edges;
  int floor = 0, ceiling = 0;
};

/// What a building has in common.
struct Style {
  float wall = 0.2f;  ///< thickness
  int trim = 0, door = 0, frame = 0, metal = 0, dark = 0, white = 0;
  Material wood;
};

struct Set {
  Scene& scene;
  Dice dice;
  RoomOptions options;
  Style style;
  std::vector<Footprint> footprints;
  std::vector<Top> tops;

  int add(const Material& m) {
    scene.materials.push_back(m);
    return static_cast<int>(scene.materials.size() - 1);
  }
  int add(const Texture& t) {
    scene.pictures.emplace_back(t);
    return static_cast<int>(scene.pictures.size() - 1);
  }
  void add(const LightGroup& g) {
    if (!g.emitters.empty() && scene.lights.size() < kMostLights) scene.lights.push_back(g);
  }
  Builder solid(const Frame& f = {}) { return Builder(scene.solid, f); }
  Builder lamps(const Frame& f = {}) { return Builder(scene.lamps, f); }
};

// palette.cpp: colours and materials as buildings have them.
Vec srgb(float r, float g, float b);
Vec hsv(float hue, float saturation, float value);  ///< linear colour; all in [0,1]
float any_hue(Dice& d);                             ///< warm and blue ones are commonest
Vec paint(Dice& d);                                 ///< of a wall: mostly white, grey, cream
Vec any_color(Dice& d);                             ///< of things
Material plain(Vec color, float gloss = 0);
Material wall_material(Dice& d, Vec color);
Material floor_material(Dice& d, RoomKind kind);
Material wood_material(Dice& d);
Material cloth(Dice& d);
Material surface(Dice& d);  ///< of a cupboard or table: wood, white, a colour
Material metal(Dice& d);
/// Shapes, gradients, lines of text: posters, screens, covers, labels.
Texture poster(Dice& d, int width, int height);
int poster_material(Set& set, Dice& d, int size = 96);

// building.cpp, walls.cpp
std::vector<Plan> plan_building(Set& set);
void build_walls(Set& set, Plan& plan, bool first);

// furnish.cpp
void furnish_space(Set& set, const Plan& plan, bool main);

}  // namespace ps::rooms
