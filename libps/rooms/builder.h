// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <array>
#include <vector>

#include "libps/rooms/mesh.h"

namespace ps::rooms {

/// Adds shapes to a mesh, in a frame of its own. Textures of u, v in metres start at a place of
/// their own for each shape, so that equal boxes do not look alike.
class Builder {
 public:
  Builder(Mesh& mesh, const Frame& frame) : mesh_(mesh), frame_(frame) {}
  Builder in(const Frame& local) const { return Builder(mesh_, frame_ * local); }
  const Frame& frame() const { return frame_; }

  /// @param bevel  metres that edges are cut by and shaded round; 0 = sharp
  void box(Vec low, Vec high, int material, float bevel = 0);
  /// A box whose top is `taper` times as wide as its base.
  void tapered(Vec low, Vec high, float taper, int material);
  /// A round body about the y axis at `base`: pairs of (radius, height), from below.
  void lathe(Vec base, const std::vector<std::array<float, 2>>& profile, int material,
             int sides = 14, bool smooth = true);
  void cylinder(Vec base, float radius, float height, int material, float top_radius = -1,
                int sides = 14);
  /// A round rod from a to b.
  void rod(Vec a, Vec b, float radius, int material, int sides = 6);
  /// A stuffed box: a superellipsoid. `power` 1 = ellipsoid, smaller = more of a box.
  void cushion(Vec low, Vec high, int material, float power = 0.4f, int steps = 10);
  /// A flat sheet from `corner`; u, v in metres.
  void sheet(Vec corner, Vec along_u, Vec along_v, int material);
  /// A flat piece of the plane z = 0; u, v are x and y, so that neighbours go on in one pattern.
  void panel(float x0, float y0, float x1, float y1, int material);
  /// A flat sheet with u, v in [0,1].
  void picture(Vec corner, Vec along_u, Vec along_v, int material);
  /// A pointed leaf bent downwards by `droop`, as a strip of quads.
  void leaf(Vec root, Vec along, Vec across, float droop, int material);
  /// A hanging cloth: `folds` waves of this depth along x.
  void curtain(Vec low, float width, float height, float depth, int folds, int material,
               float phase);
  /// A flat polygon (x, z) lifted from y = low to high, with its sides.
  void prism(const std::vector<std::array<float, 2>>& outline, float low, float high, int material);
  /// A ball.
  void ball(Vec center, float radius, int material, int steps = 8) {
    const Vec r{radius, radius, radius};
    cushion(center - r, center + r, material, 1, steps);
  }

 private:
  std::uint32_t corner(Vec position, Vec normal, float u, float v);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, int material);
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, int material);
  void flat(const std::array<Vec, 4>& p, int material);  ///< u, v in metres from p[0]
  float offset();                                        ///< where a shape's texture starts

  Mesh& mesh_;
  Frame frame_;
};

}  // namespace ps::rooms
