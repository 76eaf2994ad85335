// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>

#include "libps/rooms/builder.h"
#include "libps/rooms/dice.h"

namespace ps::rooms {
namespace {

Vec random_vec(Dice& d, float size) {
  return {d.range(-size, size), d.range(-size, size), d.range(-size, size)};
}

Mesh random_triangles(Dice& d, int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec at = random_vec(d, 3);
    const auto first = static_cast<std::uint32_t>(mesh.corners.size());
    for (int k = 0; k < 3; ++k) mesh.corners.push_back({at + random_vec(d, 0.5f), {0, 1, 0}, 0, 0});
    mesh.faces.push_back({{first, first + 1, first + 2}, 0});
  }
  return mesh;
}

/// The obvious way, in double: the plane, then the three edges.
std::optional<double> meet(const Mesh& mesh, const Face& f, const Rays& r, int i) {
  struct D {
    double x, y, z;
  };
  const auto corner = [&](int k) {
    const Vec p = mesh.corners[f.corners[k]].position;
    return D{p.x, p.y, p.z};
  };
  const auto minus = [](D a, D b) { return D{a.x - b.x, a.y - b.y, a.z - b.z}; };
  const auto cross = [](D a, D b) {
    return D{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const auto dot = [](D a, D b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
  const D o{r.origin[0][i], r.origin[1][i], r.origin[2][i]};
  const D d{r.direction[0][i], r.direction[1][i], r.direction[2][i]};
  const D p[3] = {corner(0), corner(1), corner(2)};
  const D n = cross(minus(p[1], p[0]), minus(p[2], p[0]));
  const double t = dot(minus(p[0], o), n) / dot(d, n);
  if (!(t > 1e-5)) return {};
  const D at{o.x + t * d.x, o.y + t * d.y, o.z + t * d.z};
  for (int k = 0; k < 3; ++k) {
    if (dot(cross(minus(p[(k + 1) % 3], p[k]), minus(at, p[k])), n) < 0) return {};
  }
  return t;
}

Rays random_rays(Dice& d, float reach) {
  Rays rays;
  clear(rays);
  for (int i = 0; i < kRays; ++i) {
    if (i % 7 != 3) set_ray(rays, i, random_vec(d, 4), random_vec(d, 1), reach);
  }
  return rays;
}

TEST(Tree, finds_what_every_triangle_tried_in_turn_finds) {
  Dice d(1, 1);
  for (const int count : {1, 2, 5, 17, 300}) {
    const Mesh mesh = random_triangles(d, count);
    const Tree tree(mesh);
    int hits = 0, unlike = 0;
    for (int round = 0; round < 40; ++round) {
      Rays rays = random_rays(d, 1000), shadow = rays;
      const Rays sent = rays;
      nearest(tree, 5, rays);
      blocked(tree, shadow);
      for (int i = 0; i < kRays; ++i) {
        if (sent.reach[i] < 0) {
          EXPECT_EQ(rays.face[i], -1);
          continue;
        }
        double least = 1000;
        for (const Face& f : mesh.faces)
          least = std::min(least, meet(mesh, f, sent, i).value_or(1000));
        const bool hit = least < 1000;
        hits += hit ? 1 : 0;
        // A ray that grazes an edge may go either way.
        if (hit != (rays.face[i] >= 0) || std::abs(rays.reach[i] - least) > 1e-3 * least) ++unlike;
        EXPECT_EQ(shadow.reach[i] < 0, rays.face[i] >= 0);
        if (rays.face[i] >= 0) {
          EXPECT_EQ(rays.part[i], 5);
        }
      }
    }
    EXPECT_LE(unlike, 2) << count;
    EXPECT_TRUE(hits > 20 || count < 100) << count;
  }
}

TEST(Tree, gives_the_same_bytes_on_every_instruction_set) {
  Dice d(2, 1);
  const Mesh mesh = random_triangles(d, 500);
  const Tree tree(mesh);
  for (int round = 0; round < 50; ++round) {
    Rays chosen = random_rays(d, 1000), plain = chosen;
    nearest(tree, 1, chosen);
    trace_kernel::nearest_baseline(tree.root(), tree.triangles.data(), 1, &plain);
    EXPECT_EQ(std::memcmp(&chosen, &plain, sizeof(Rays)), 0);
    chosen = random_rays(d, 5);
    plain = chosen;
    blocked(tree, chosen);
    trace_kernel::blocked_baseline(tree.root(), tree.triangles.data(), &plain);
    EXPECT_EQ(std::memcmp(&chosen, &plain, sizeof(Rays)), 0);
  }
}

TEST(Tree, meets_a_box_where_slabs_say) {
  Mesh mesh;
  const Vec low{-1, -0.5f, 2}, high{1.5f, 0.7f, 4};
  Builder(mesh, {}).box(low, high, 0);
  const Tree tree(mesh);
  Dice d(3, 1);
  int hits = 0;
  for (int round = 0; round < 100; ++round) {
    Rays rays;
    clear(rays);
    for (int i = 0; i < kRays; ++i) {
      set_ray(rays, i, {d.range(-3, 3), d.range(-3, 3), d.range(-2, 1)},
              {d.range(-0.7f, 0.7f), d.range(-0.7f, 0.7f), 1}, 1000);
    }
    nearest(tree, 0, rays);
    for (int i = 0; i < kRays; ++i) {
      double in = 0, out = 1000;
      const double l[3] = {low.x, low.y, low.z}, h[3] = {high.x, high.y, high.z};
      for (int a = 0; a < 3; ++a) {
        const double s = (l[a] - rays.origin[a][i]) / rays.direction[a][i];
        const double t = (h[a] - rays.origin[a][i]) / rays.direction[a][i];
        in = std::max(in, std::min(s, t));
        out = std::min(out, std::max(s, t));
      }
      if (std::abs(in - out) < 1e-4) continue;
      ASSERT_EQ(in < out, rays.face[i] >= 0);
      if (in >= out) continue;
      ++hits;
      EXPECT_NEAR(rays.reach[i], in, 2e-6 * in);
    }
  }
  EXPECT_GT(hits, 100);
}

TEST(Tree, of_no_triangles_is_met_by_no_ray) {
  const Tree tree{Mesh{}};
  Dice d(4, 1);
  Rays rays = random_rays(d, 10);
  nearest(tree, 0, rays);
  for (int i = 0; i < kRays; ++i) EXPECT_EQ(rays.face[i], -1);
}

TEST(Tree, of_many_triangles_in_one_place_is_built) {
  Mesh mesh;
  for (int i = 0; i < 100; ++i) Builder(mesh, {}).sheet({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0);
  const Tree tree(mesh);
  Rays rays;
  clear(rays);
  set_ray(rays, 0, {0.3f, 0.4f, 0}, {0, 0, 1}, 10);
  nearest(tree, 0, rays);
  EXPECT_FLOAT_EQ(rays.reach[0], 1);
}

}  // namespace
}  // namespace ps::rooms
