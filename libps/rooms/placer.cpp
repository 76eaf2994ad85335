// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/placer.h"

namespace ps::rooms {

Rect bounds_of(const Frame& f, float width, float depth) {
  Rect r{1e9f, 1e9f, -1e9f, -1e9f};
  for (const float sx : {-0.5f, 0.5f}) {
    for (const float sz : {-0.5f, 0.5f}) {
      const Vec p = f.point({sx * width, 0, sz * depth});
      r = {std::min(r.x0, p.x), std::min(r.z0, p.z), std::max(r.x1, p.x), std::max(r.z1, p.z)};
    }
  }
  return r;
}

Placer::Placer(Set& set, const Plan& plan) : set_(set), plan_(plan), d_(set.dice.child()) {
  for (const Edge& e : plan.edges) {
    for (const Opening& o : e.openings) {
      if (o.kind == Opening::window) continue;
      const Frame f = e.frame * at((o.from + o.to) / 2, 0, 0.45f);
      set_.footprints.push_back({bounds_of(f, o.to - o.from, 0.9f), 0, 2});
    }
  }
}

bool Placer::free(const Rect& r, float low, float high) const {
  bool inside = false;
  for (const Rect& q : plan_.rects) {
    inside |= r.x0 >= q.x0 && r.x1 <= q.x1 && r.z0 >= q.z0 && r.z1 <= q.z1;
  }
  if (!inside) return false;
  for (const Footprint& f : set_.footprints) {
    if (f.low < high && f.high > low && f.rect.meets(r)) return false;
  }
  return true;
}

void Placer::draw(const Piece& p, const Frame& f) {
  stand(bounds_of(f, p.size.x, p.size.z), p.size.y);
  p.draw(set_, set_.solid(f));
}

void Placer::stand(const Rect& r, float height) {
  set_.footprints.push_back({r, 0, height});
  set_.scene.things.push_back({Vec{r.x0, 0, r.z0}, Vec{r.x1, height, r.z1}});
}

bool Placer::wall(const Piece& p) {
  for (int attempt = 0; attempt < 14; ++attempt) {
    const Edge& e = plan_.edges[d_.below(static_cast<int>(plan_.edges.size()))];
    if (e.length < p.size.x + 0.05f) continue;
    float x = d_.range(p.size.x / 2, e.length - p.size.x / 2);
    if (d_.chance(0.35f))
      x = d_.chance(0.5f) ? p.size.x / 2 + 0.02f : e.length - p.size.x / 2 - 0.02f;
    if (covers(e, x, p.size.x, 0, p.size.y)) continue;
    const Frame f =
        e.frame * at(x, 0, p.size.z / 2 + (d_.chance(0.8f) ? 0.02f : d_.range(0.02f, 0.15f)));
    if (!free(bounds_of(f, p.size.x, p.size.z - 0.02f), 0, p.size.y)) continue;
    draw(p, f);
    return true;
  }
  return false;
}

bool Placer::covers(const Edge& e, float x, float width, float low, float high) const {
  for (const Opening& o : e.openings) {
    if (x + width / 2 < o.from - 0.05f || x - width / 2 > o.to + 0.05f) continue;
    if (high > o.bottom && low < o.top) return true;
  }
  return false;
}

bool Placer::loose(const Piece& p) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    const Rect& r = plan_.rects[d_.below(static_cast<int>(plan_.rects.size()))];
    float turn = static_cast<float>(d_.below(4)) * 1.5707963f;
    if (d_.chance(0.4f)) turn += d_.range(-0.5f, 0.5f);
    const Frame f = turned(turn, {d_.range(r.x0, r.x1), 0, d_.range(r.z0, r.z1)});
    if (!free(bounds_of(f, p.size.x, p.size.z), 0, p.size.y)) continue;
    draw(p, f);
    return true;
  }
  return false;
}

bool Placer::hang(const Piece& p, float low, float high) {
  for (int attempt = 0; attempt < 8; ++attempt) {
    const Edge& e = plan_.edges[d_.below(static_cast<int>(plan_.edges.size()))];
    if (e.length < p.size.x + 0.1f) continue;
    const float x = d_.range(p.size.x / 2 + 0.03f, e.length - p.size.x / 2 - 0.03f),
                y = d_.range(low, high);
    if (y + p.size.y > plan_.height || covers(e, x, p.size.x + 0.15f, y, y + p.size.y)) continue;
    const Frame f = e.frame * at(x, y, 0.001f);
    if (!free(bounds_of(f * at(0, 0, p.size.z / 2 + 0.01f), p.size.x, p.size.z), y, y + p.size.y))
      continue;
    set_.footprints.push_back({bounds_of(f, p.size.x, 2 * p.size.z), y, y + p.size.y});
    p.draw(set_, set_.solid(f));
    return true;
  }
  return false;
}

}  // namespace ps::rooms
