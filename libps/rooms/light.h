// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include "libps/rooms/scene.h"

namespace ps::rooms {

/// A place to be lit. A packet holds kRays of these.
struct Lit {
  const Space* space = nullptr;  ///< it is in; null = no place
  Vec position;                  ///< a little above its surface
  Vec normal;
  float choice = 0.5f, s = 0.5f, t = 0.5f;  ///< in [0,1): which lamp, and where on it
  Vec irradiance;                           ///< what came, added to
};

/// Adds the light that comes straight from lamps, windows and the sun: a shadow ray for each of the
/// strongest groups of lights, one for a random group of the others. Too little to be seen is left
/// out.
void add_direct(const Scene& scene, Lit* lit);

/// Finds which lights reach a space at all, by random rays: sets its lit_by and sunny.
void find_lights(const Scene& scene, Space& space);

/// Fills the probes of all spaces with bounce light and sets the exposure.
void bake(Scene& scene);

}  // namespace ps::rooms
