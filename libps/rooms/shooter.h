// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include "libps/rooms/light.h"
#include "libps/rooms/picture_plane.h"
#include "libps/rooms/shot.h"

namespace ps::rooms {

/// Draws one shot: what each pixel sees, its light, its reflections, then edges.
class Shooter {
 public:
  Shooter(const Scene& scene, const Camera& camera);
  Shot shoot();

 private:
  Pixel see(const Rays& rays, int i) const;
  /// What 4x4 pixels see.
  void look(int x0, int y0);
  /// @return true if these pixels are of one flat surface
  bool even(int x0, int y0, int side) const;
  /// Light on 4x4 pixels, or squares of `stride` pixels, each with its own sample of the lamps.
  /// @return false if it varies much
  bool light(int x0, int y0, int stride);
  void reflect();
  void reflect(const std::uint32_t* pixels, int count);
  /// More rays where surfaces meet.
  /// @param colors  three for each pixel
  void smooth_edges(std::vector<float>& colors) const;
  /// What ray k, near the middle of pixel i, brings to the eye.
  Vec extra(const Rays& rays, int k, std::size_t i) const;
  /// What a surface sends to the eye in the light of pixel i.
  Vec radiance(const Pixel& p, std::size_t i) const;

  const Scene& scene_;
  const Camera& camera_;
  Vec eye_;
  PicturePlane plane_;
};

}  // namespace ps::rooms
