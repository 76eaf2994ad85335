// SPDX-License-Identifier: BSD-3-Clause
// Floor plans: a main room, its openings, and further rooms behind open doors.
#include "libps/rooms/set.h"

namespace ps::rooms {
namespace {

struct Size {
  float width, depth, height;
};

Size room_size(Dice& d, RoomKind kind) {
  switch (kind) {
    case RoomKind::bedroom:
      return {d.range(2.7f, 4.6f), d.range(2.9f, 5), d.range(2.3f, 2.9f)};
    case RoomKind::living_room:
      return {d.range(3.4f, 7), d.range(3.8f, 8), d.range(2.4f, 3.3f)};
    case RoomKind::kitchen:
      return {d.range(2.2f, 5.5f), d.range(2.6f, 6), d.range(2.3f, 2.9f)};
    case RoomKind::office:
      return {d.range(2.8f, 8), d.range(3.2f, 11), d.range(2.4f, 3.4f)};
    case RoomKind::bathroom:
      return {d.range(1.7f, 3.2f), d.range(2, 3.6f), d.range(2.2f, 2.7f)};
    case RoomKind::corridor:
      return {d.range(1.2f, 2.6f), d.range(5, 16), d.range(2.3f, 3)};
    case RoomKind::hall:
      return {d.range(4.5f, 10), d.range(5, 14), d.range(2.7f, 4.8f)};
    case RoomKind::storage:
      return {d.range(1.8f, 5), d.range(2.2f, 6), d.range(2.3f, 3.2f)};
  }
  return {4, 4, 2.5f};
}

/// An edge from p to q with the room on its left as seen from above with z down: z of its frame
/// points inwards.
Edge edge_between(std::array<float, 2> p, std::array<float, 2> q) {
  const float dx = q[0] - p[0], dz = q[1] - p[1];
  Edge e;
  e.length = std::sqrt(dx * dx + dz * dz);
  const Vec along = Vec{dx, 0, dz} * (1 / e.length);
  e.frame = {along, {0, 1, 0}, {-along.z, 0, along.x}, {p[0], 0, p[1]}};
  return e;
}

void set_outline(Plan& plan, const std::vector<std::array<float, 2>>& outline) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    plan.edges.push_back(edge_between(outline[i], outline[(i + 1) % outline.size()]));
  }
}

void rectangle(Plan& plan, const Rect& r) {
  plan.rects = {r};
  set_outline(plan, {{r.x0, r.z0}, {r.x1, r.z0}, {r.x1, r.z1}, {r.x0, r.z1}});
}

/// A rectangle, an L, or one with a niche.
void main_outline(Plan& plan, Dice& d, const Size& s) {
  const Rect r{-s.width / 2, -s.depth / 2, s.width / 2, s.depth / 2};
  const bool small = s.width < 2.6f || plan.kind == RoomKind::corridor;
  const float kind = small ? 0 : d.unit();
  if (kind < 0.6f) return rectangle(plan, r);
  if (kind < 0.82f) {  // an L: the corner at (x1, z1) is missing
    const float x = r.x1 - s.width * d.range(0.25f, 0.5f),
                z = r.z1 - s.depth * d.range(0.25f, 0.5f);
    plan.rects = {{r.x0, r.z0, r.x1, z}, {r.x0, z, x, r.z1}};
    set_outline(plan, {{r.x0, r.z0}, {r.x1, r.z0}, {r.x1, z}, {x, z}, {x, r.z1}, {r.x0, r.z1}});
    return;
  }
  const float wide = s.width * d.range(0.3f, 0.6f), deep = d.range(0.3f, 1.5f);
  const float x0 = d.range(r.x0 + 0.2f, r.x1 - wide - 0.2f);
  plan.rects = {r, {x0, r.z1, x0 + wide, r.z1 + deep}};
  set_outline(plan, {{r.x0, r.z0},
                     {r.x1, r.z0},
                     {r.x1, r.z1},
                     {x0 + wide, r.z1},
                     {x0 + wide, r.z1 + deep},
                     {x0, r.z1 + deep},
                     {x0, r.z1},
                     {r.x0, r.z1}});
}

bool free_along(const Edge& e, float from, float to) {
  if (from < 0.15f || to > e.length - 0.15f) return false;
  for (const Opening& o : e.openings) {
    if (from < o.to + 0.25f && to > o.from - 0.25f) return false;
  }
  return true;
}

bool put(Dice& d, Edge& e, Opening o, float width) {
  for (int attempt = 0; attempt < 4; ++attempt) {
    o.from = d.range(0.2f, std::max(0.21f, e.length - width - 0.2f));
    o.to = o.from + width;
    if (!free_along(e, o.from, o.to)) continue;
    e.openings.push_back(o);
    return true;
  }
  return false;
}

void put_windows(Dice& d, Plan& plan, Edge& e) {
  Opening o;
  o.bottom = d.chance(0.2f) ? d.range(0.05f, 0.3f) : d.range(0.6f, 1.2f);
  o.top = std::min(plan.height - d.range(0.1f, 0.4f), o.bottom + d.range(0.9f, 2.2f));
  if (plan.kind == RoomKind::bathroom) o.bottom = o.top - d.range(0.4f, 0.9f);
  const float width = std::min(e.length - 0.5f, d.range(0.6f, 2.4f));
  if (width < 0.4f) return;
  const int count = std::max(1, static_cast<int>(e.length / (width + d.range(0.4f, 1.5f))));
  const float pitch = e.length / static_cast<float>(count);
  for (int i = 0; i < count; ++i) {
    o.from = pitch * (static_cast<float>(i) + 0.5f) - width / 2;
    o.to = o.from + width;
    if (free_along(e, o.from, o.to)) e.openings.push_back(o);
  }
}

void put_door(Dice& d, const Plan& plan, Edge& e, float open) {
  Opening o;
  o.top = std::min(plan.height - 0.1f, d.range(1.98f, 2.25f));
  float width = d.range(0.75f, 1);
  if (d.chance(0.12f)) width = d.range(1.3f, 1.8f);
  o.kind = d.chance(open) ? Opening::open_door : Opening::closed_door;
  if (d.chance(0.25f) && e.length > 2) {
    o.kind = Opening::archway;
    width = std::min(e.length - 0.8f, d.range(0.9f, 3));
    o.top = std::min(plan.height - (d.chance(0.3f) ? 0.02f : 0.2f), d.range(2, 2.9f));
  }
  put(d, e, o, width);
}

void put_openings(Dice& d, Plan& plan) {
  const int n = static_cast<int>(plan.edges.size());
  const bool corridor = plan.kind == RoomKind::corridor;
  const bool windows = !d.chance(plan.kind == RoomKind::storage    ? 0.7f
                                 : plan.kind == RoomKind::bathroom ? 0.5f
                                                                   : 0.1f);
  int doors = 0;
  const int outer = d.below(n);
  for (int k = 0; k < n; ++k) {
    Edge& e = plan.edges[(outer + k) % n];
    if (e.length < 1.1f) continue;
    const bool outside =
        windows && (corridor ? e.length < 3 || d.chance(0.15f) : k == 0 || d.chance(0.25f));
    if (outside) {
      put_windows(d, plan, e);
    } else if (corridor && e.length > 3) {
      const int count = static_cast<int>(e.length / d.range(1.6f, 4));
      for (int i = 0; i < count; ++i) put_door(d, plan, e, 0.5f);
    } else if (doors == 0 || d.chance(0.4f)) {
      put_door(d, plan, e, 0.6f);
      ++doors;
    }
  }
}

/// The rectangle behind an opening.
Rect behind(Dice& d, const Edge& e, const Opening& o, const Size& s, float wall) {
  const float width = std::max(s.width, o.to - o.from + 0.4f);
  const float slack = width - (o.to - o.from) - 0.4f;
  const float from = o.from - 0.2f - slack * d.unit();
  const Vec a = e.frame.point({from, 0, -wall});
  const Vec b = e.frame.point({from + width, 0, -wall - s.depth});
  return {std::min(a.x, b.x), std::min(a.z, b.z), std::max(a.x, b.x), std::max(a.z, b.z)};
}

/// The same hole, seen from the room behind: on the edge that runs the other way.
void mirror_opening(Plan& plan, const Edge& e, Opening o) {
  const Vec a = e.frame.point({o.from, 0, 0}), b = e.frame.point({o.to, 0, 0});
  if (o.kind != Opening::archway) o.kind = Opening::open_door;
  o.behind = true;
  for (Edge& other : plan.edges) {
    if (dot(other.frame.ez, e.frame.ez) > -0.99f) continue;
    const float p = dot(b - other.frame.origin, other.frame.ex);
    const float q = dot(a - other.frame.origin, other.frame.ex);
    o.from = std::min(p, q);
    o.to = std::max(p, q);
    other.openings.push_back(o);
    return;
  }
}

bool overlaps(const std::vector<Plan>& plans, const Rect& r, float wall) {
  for (const Plan& p : plans) {
    for (const Rect& q : p.rects) {
      if (q.grown(wall * 0.9f).meets(r)) return true;
    }
  }
  return false;
}

/// Puts rooms behind the open doors of plan `index`; doors without a place for one are closed.
void put_neighbours(Set& set, std::vector<Plan>& plans, std::size_t index, bool further) {
  Dice& d = set.dice;
  for (std::size_t k = 0; k < plans[index].edges.size(); ++k) {
    for (std::size_t j = 0; j < plans[index].edges[k].openings.size(); ++j) {
      const Edge edge = plans[index].edges[k];
      const Opening o = edge.openings[j];
      if (o.kind != Opening::open_door && o.kind != Opening::archway) continue;
      Plan next;
      next.kind = static_cast<RoomKind>(d.below(kRoomKinds));
      Size s = room_size(d, next.kind);
      if (next.kind == RoomKind::corridor && d.chance(0.6f)) std::swap(s.width, s.depth);
      next.height = std::max(o.top + 0.05f, d.chance(0.6f) ? plans[index].height : s.height);
      Rect r;
      bool fits = false;
      for (int attempt = 0; attempt < 5 && !fits && plans.size() < 6; ++attempt) {
        r = behind(d, edge, o, s, set.style.wall);
        fits = !overlaps(plans, r, set.style.wall);
        s.width *= 0.8f;
        s.depth *= 0.8f;
      }
      if (!fits) {
        plans[index].edges[k].openings[j].kind = Opening::closed_door;
        if (o.to - o.from > 1.9f) plans[index].edges[k].openings[j].to = o.from + 0.9f;
        continue;
      }
      rectangle(next, r);
      mirror_opening(next, edge, o);
      if (further) {
        put_openings(d, next);
      } else {
        put_windows(d, next, next.edges[d.below(4)]);
      }
      plans.push_back(std::move(next));
    }
  }
}

}  // namespace

std::vector<Plan> plan_building(Set& set) {
  Dice& d = set.dice;
  std::vector<Plan> plans(1);
  plans[0].kind = set.scene.spaces[0].kind;
  const Size s = room_size(d, plans[0].kind);
  plans[0].height = s.height;
  main_outline(plans[0], d, s);
  put_openings(d, plans[0]);
  put_neighbours(set, plans, 0, true);
  const std::size_t near = plans.size();
  for (std::size_t i = 1; i < near; ++i) put_neighbours(set, plans, i, false);
  return plans;
}

}  // namespace ps::rooms
