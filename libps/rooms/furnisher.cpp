// SPDX-License-Identifier: BSD-3-Clause
// Which things stand in a space.
#include "libps/rooms/placer.h"

namespace ps::rooms {
namespace {

/// Decides what stands in a room.
class Furnisher : private Placer {
 public:
  using Placer::Placer;

  void furnish(bool main) {
    switch (plan_.kind) {
      case RoomKind::bedroom:
        wall(real(Role::bed, bed(set_, d_)));
        some(0, 2, [&] { wall(a_cupboard(0.4f, 0.65f)); });
        some(0, 2, [&] { wall(a_cupboard(1.7f, 2.3f)); });
        maybe(0.5f, [&] { wall(a_shelf()); });
        maybe(0.5f, [&] { workplace(true); });
        maybe(0.4f, [&] { wall(a_cupboard(0.6f, 1.2f)); });
        maybe(0.3f, [&] { loose(a_sofa(true)); });
        break;
      case RoomKind::living_room:
        wall(a_sofa(false));
        maybe(0.5f, [&] { loose(a_sofa(false)); });
        some(0, 2, [&] { loose(a_sofa(true)); });
        maybe(0.8f, [&] { loose(real(Role::table, table(set_, d_, true))); });
        some(0, 3, [&] { wall(a_shelf()); });
        some(0, 2, [&] { wall(a_cupboard(0.35f, 1.1f)); });
        maybe(0.4f, [&] { dining(); });
        maybe(0.6f, [&] { hang(wall_screen(set_, d_), 0.7f, 1.2f); });
        maybe(0.1f, [&] { wall(piano(set_, d_)); });
        maybe(0.1f, [&] { loose(table_game(set_, d_)); });
        break;
      case RoomKind::kitchen:
        wall(kitchen_row(set_, d_, d_.range(1.6f, 3.8f)));
        maybe(0.5f, [&] { wall(kitchen_row(set_, d_, d_.range(1, 2.5f))); });
        wall(fridge(set_, d_));
        maybe(0.8f, [&] { dining(); });
        maybe(0.3f, [&] { loose(counter(set_, d_)); });
        some(0, 2, [&] { wall(a_cupboard(0.8f, 2.1f)); });
        break;
      case RoomKind::office:
        offices();
        some(0, 3, [&] { wall(a_shelf()); });
        some(0, 3, [&] { wall(a_cupboard(0.7f, 2)); });
        maybe(0.5f, [&] { hang(wall_board(set_, d_), 0.8f, 1.1f); });
        maybe(0.25f, [&] { dining(); });
        some(0, 2, [&] { loose(partition(set_, d_, plan_.height)); });
        maybe(0.15f, [&] { column(); });
        maybe(0.25f, [&] { loose(easel(set_, d_)); });
        break;
      case RoomKind::bathroom:
        wall(basin(set_, d_));
        wall(toilet(set_, d_));
        maybe(0.6f, [&] { wall(bathtub(set_, d_)); });
        hang(wall_mirror(set_, d_), 1, 1.3f);
        maybe(0.5f, [&] { wall(a_cupboard(0.6f, 1.9f)); });
        break;
      case RoomKind::corridor:
        some(0, 4, [&] { wall(a_cupboard(0.7f, 2)); });
        some(0, 2, [&] { wall(a_shelf()); });
        some(0, 3, [&] { wall(a_chair()); });
        maybe(0.3f, [&] { wall(locker_row(set_, d_)); });
        maybe(0.4f, [&] { hang(coat_rack(set_, d_), 0.5f, 0.8f); });
        break;
      case RoomKind::hall:
        some(0, 3, [&] { dining(); });
        some(0, 3, [&] { loose(a_sofa(d_.chance(0.4f))); });
        some(0, 2, [&] { loose(counter(set_, d_)); });
        some(0, 4, [&] { wall(a_cupboard(0.7f, 2)); });
        some(0, 3, [&] { column(); });
        maybe(0.35f, [&] { wall(stairs(set_, d_, plan_.height)); });
        maybe(0.3f, [&] { loose(partition(set_, d_, plan_.height)); });
        maybe(0.2f, [&] { loose(table_game(set_, d_)); });
        some(0, 3, [&] { loose(a_plant()); });
        break;
      case RoomKind::storage:
        some(2, 7, [&] { wall(a_shelf()); });
        some(0, 3, [&] { wall(a_cupboard(0.7f, 2)); });
        some(1, 9, [&] { loose(box_pile(set_, d_)); });
        maybe(0.4f, [&] { wall(locker_row(set_, d_)); });
        maybe(0.6f, [&] { loose(stepladder(set_, d_)); });
        break;
    }
    common(main ? 1.f : 0.5f);
  }

 private:
  template <typename F>
  void some(int low, int high, F f) {
    const int n = d_.whole(low, high);
    for (int i = 0; i < n; ++i) f();
  }
  template <typename F>
  void maybe(float p, F f) {
    if (d_.chance(p)) f();
  }

  /// Often a real model in its place.
  Piece real(Role role, Piece otherwise) {
    return model_or(set_, d_, role, plan_.kind, std::move(otherwise));
  }
  Piece a_shelf() { return real(Role::storage, shelf(set_, d_)); }
  Piece a_cupboard(float low, float high) {
    return real(Role::storage, cupboard(set_, d_, low, high));
  }
  Piece a_sofa(bool single) { return real(Role::couch, sofa(set_, d_, single)); }
  Piece a_chair() { return real(Role::seat, chair(set_, d_)); }
  Piece a_plant() { return real(Role::plant, plant(set_, d_)); }

  /// A table with chairs around it, at most tucked under.
  void dining() {
    const bool round = d_.chance(0.3f);
    const Piece t = real(Role::table, round ? round_table(set_, d_) : table(set_, d_, false));
    const float margin = 1.1f;
    for (int attempt = 0; attempt < 14; ++attempt) {
      const Rect& r = plan_.rects[d_.below(static_cast<int>(plan_.rects.size()))];
      const float turn = static_cast<float>(d_.below(2)) * 1.5707963f +
                         (d_.chance(0.2f) ? d_.range(-0.3f, 0.3f) : 0);
      const Frame f = turned(turn, {d_.range(r.x0, r.x1), 0, d_.range(r.z0, r.z1)});
      const float around = attempt < 8 ? margin : 0.2f;
      if (!free(bounds_of(f, t.size.x + around, t.size.z + around), 0, 1)) continue;
      draw(t, f);
      const Piece seat = d_.chance(0.1f) ? stool(set_, d_) : a_chair();
      const int sides = std::max(1, static_cast<int>(t.size.x / 0.65f));
      const float full = d_.range(0.4f, 1);
      for (int i = 0; i < sides; ++i) {
        const float x =
            t.size.x * ((static_cast<float>(i) + 0.5f) / static_cast<float>(sides) - 0.5f);
        for (const float s : {-1.f, 1.f})
          seat_at(f, seat, {x, 0, s * t.size.z / 2}, s > 0 ? 3.1415927f : 0, full);
      }
      if (t.size.x > 0.9f || round) {
        for (const float s : {-1.f, 1.f})
          seat_at(f, seat, {s * t.size.x / 2, 0, 0}, s > 0 ? -1.5707963f : 1.5707963f, full * 0.7f);
      }
      return;
    }
  }

  /// A seat that faces `turn`, standing back from the edge of a table.
  void seat_at(const Frame& table, const Piece& seat, Vec edge, float turn, float chance) {
    if (!d_.chance(chance)) return;
    const float back = d_.chance(0.7f) ? d_.range(-0.05f, 0.2f) : d_.range(0.2f, 0.6f);
    const Frame f = table * turned(turn, edge) * at(0, 0, -back - seat.size.z * 0.35f) *
                    turned(d_.chance(0.8f) ? d_.normal() * 0.12f : d_.range(-1, 1));
    const Rect r = bounds_of(f, seat.size.x, seat.size.z);
    const Vec middle = f.origin;
    if (!free({middle.x - 0.05f, middle.z - 0.05f, middle.x + 0.05f, middle.z + 0.05f}, 0, 0.3f) &&
        back > 0.1f) {
      return;
    }
    for (const Rect& q : plan_.rects) {
      if (r.x0 < q.x0 || r.x1 > q.x1 || r.z0 < q.z0 || r.z1 > q.z1) continue;
      stand(r, seat.size.y);
      seat.draw(set_, set_.solid(f));
      return;
    }
  }

  /// A desk with its chair.
  void workplace(bool at_wall) {
    const Piece t = d_.chance(0.7f) ? desk(set_, d_) : real(Role::table, desk(set_, d_));
    for (int attempt = 0; attempt < 12; ++attempt) {
      Frame f;
      if (at_wall) {
        const Edge& e = plan_.edges[d_.below(static_cast<int>(plan_.edges.size()))];
        if (e.length < t.size.x) continue;
        const float x = d_.range(t.size.x / 2, e.length - t.size.x / 2);
        if (covers(e, x, t.size.x, 0, 0.8f)) continue;
        f = e.frame * at(x, 0, t.size.z / 2 + 0.03f);
      } else {
        const Rect& r = plan_.rects[0];
        f = turned(static_cast<float>(d_.below(4)) * 1.5707963f,
                   {d_.range(r.x0, r.x1), 0, d_.range(r.z0, r.z1)});
      }
      if (!free(bounds_of(f * at(0, 0, 0.3f), t.size.x, t.size.z + 0.6f), 0, 1.1f)) continue;
      draw(t, f);
      seat_at(f, d_.chance(0.8f) ? real(Role::seat, office_chair(set_, d_)) : a_chair(),
              {0, 0, t.size.z / 2}, 3.1415927f, 0.9f);
      return;
    }
  }

  void offices() {
    const Rect& r = plan_.rects[0];
    const int count = 1 + static_cast<int>(r.width() * r.depth() * d_.range(0.05f, 0.16f));
    const bool at_wall = d_.chance(0.5f);
    for (int i = 0; i < count; ++i) workplace(at_wall || d_.chance(0.3f));
  }

  void column() {
    const float w = d_.range(0.25f, 0.6f), high = plan_.height;
    const int m = d_.chance(0.6f) ? plan_.edges[0].material : set_.add(surface(d_));
    const bool round = d_.chance(0.4f);
    loose({{w, high, w}, [=](Set&, Builder b) {
             if (round) {
               b.cylinder({}, w / 2, high, m, -1, 20);
             } else {
               b.box({-w / 2, 0, -w / 2}, {w / 2, high, w / 2}, m);
             }
           }});
  }

  void rug() {
    const Rect& r = plan_.rects[d_.below(static_cast<int>(plan_.rects.size()))];
    const float w = std::min(r.width() * 0.8f, d_.range(0.8f, 3)),
                depth = std::min(r.depth() * 0.8f, d_.range(0.6f, 2.2f));
    Material m = cloth(d_);
    if (d_.chance(0.4f))
      m.pattern = d_.pick({Pattern::blobs, Pattern::stripes, Pattern::checks}),
      m.scale = d_.range(0.05f, 0.4f);
    const int material = set_.add(m);
    const Frame f = turned(
        d_.chance(0.7f) ? 0 : d_.range(-0.5f, 0.5f),
        {d_.range(r.x0 + w / 2, r.x1 - w / 2), 0, d_.range(r.z0 + depth / 2, r.z1 - depth / 2)});
    if (d_.chance(0.8f)) {
      set_.solid(f).box({-w / 2, 0, -depth / 2}, {w / 2, 0.008f, depth / 2}, material);
    } else {
      set_.solid(f).cylinder({}, depth / 2, 0.008f, material, -1, 28);
    }
  }

  /// Furniture that suits the room, one at a time, until this share of the floor is taken.
  void fill(float share) {
    float floor = 0, taken = 0;
    for (const Rect& r : plan_.rects) floor += r.width() * r.depth();
    for (int i = 0; i < 30 && taken < share * floor; ++i) {
      const bool against = d_.chance(0.65f);
      const Piece p = against ? wall_piece() : loose_piece();
      if (against ? wall(p) : loose(p)) taken += p.size.x * p.size.z;
    }
  }

  Piece wall_piece() {
    if (wants_model(set_, d_) && d_.chance(0.4f)) return real(Role::other, a_shelf());
    const int pick = d_.below(12);
    if (pick < 3) return a_shelf();
    if (pick < 5) return a_cupboard(0.6f, 1.3f);
    if (pick < 7) return a_cupboard(1.4f, 2.2f);
    if (pick < 8) return table(set_, d_, false);
    if (pick < 9) return a_plant();
    if (pick < 10) return a_sofa(d_.chance(0.5f));
    return pick < 11 ? desk(set_, d_) : box_pile(set_, d_);
  }

  Piece loose_piece() {
    if (wants_model(set_, d_) && d_.chance(0.4f)) return real(Role::other, a_chair());
    const int pick = d_.below(12);
    if (pick < 3) return a_chair();
    if (pick < 4) return office_chair(set_, d_);
    if (pick < 6) return real(Role::table, table(set_, d_, d_.chance(0.4f)));
    if (pick < 7) return round_table(set_, d_);
    if (pick < 9) return a_plant();
    if (pick < 10) return a_sofa(true);
    return pick < 11 ? box_pile(set_, d_) : a_cupboard(0.4f, 1.2f);
  }

  /// What only models are: on walls, ceilings, doors, odd things.
  void models(float share) {
    const auto n = [&](float most) { return d_.below(1 + static_cast<int>(most * share)); };
    float elevation = 0;
    for (int i = n(4); i > 0; --i) {
      const Piece p = hanging_model(set_, d_, false, elevation);
      if (p.draw) hang(p, elevation, elevation + 0.05f);
    }
    for (int i = n(2); i > 0; --i) {
      const Piece p = hanging_model(set_, d_, true, elevation);
      const Rect& r = plan_.rects[0];
      if (!p.draw || plan_.height - p.size.y < 1.9f) continue;
      const Frame f = turned(static_cast<float>(d_.below(4)) * 1.5707963f,
                             {d_.range(r.x0 + 0.4f, r.x1 - 0.4f), plan_.height - p.size.y,
                              d_.range(r.z0 + 0.4f, r.z1 - 0.4f)});
      p.draw(set_, set_.solid(f));
    }
    for (int i = n(2); i > 0; --i) {
      const Piece p = real(Role::door, {});
      if (p.draw) wall(p);
    }
    for (int i = n(3); i > 0; --i) {
      const Piece p = real(Role::other, {});
      if (p.draw) d_.chance(0.5f) ? wall(p) : loose(p);
    }
  }

  void common(float share) {
    const bool narrow = plan_.kind == RoomKind::corridor || plan_.kind == RoomKind::bathroom;
    fill(share * d_.unit() * (narrow ? 0.06f : 0.3f));
    const auto n = [&](float most) { return d_.below(1 + static_cast<int>(most * share)); };
    if (set_.scene.furniture) models(share);
    const bool home = plan_.kind == RoomKind::living_room || plan_.kind == RoomKind::bedroom;
    if (d_.chance(home ? 0.7f : 0.15f)) rug();
    for (int i = n(7); i > 0; --i) hang(wall_picture(set_, d_), 0.7f, 1.6f);
    for (int i = n(2); i > 0; --i) hang(wall_shelf(set_, d_), 1, 1.8f);
    for (int i = n(5); i > 0; --i) hang(wall_socket(set_, d_), 0.15f, 0.4f);
    for (int i = n(3); i > 0; --i) hang(wall_socket(set_, d_), 1, 1.2f);
    if (d_.chance(0.2f)) hang(wall_clock(set_, d_), 1.6f, 2);
    if (d_.chance(0.12f)) hang(wall_mirror(set_, d_), 0.5f, 1);
    if (d_.chance(0.1f)) hang(wall_board(set_, d_), 0.8f, 1.1f);
    if (d_.chance(0.1f)) hang(wall_screen(set_, d_), 0.8f, 1.3f);
    if (d_.chance(home ? 0.5f : 0.1f)) loose(floor_lamp(set_, d_));
    for (int i = n(plan_.kind == RoomKind::storage ? 1 : 4); i > 0; --i)
      d_.chance(0.6f) ? wall(a_plant()) : loose(a_plant());
    for (int i = n(3); i > 0; --i) wall(bin(set_, d_));
    for (int i = n(3); i > 0; --i) loose(box_pile(set_, d_));
    for (int i = n(3); i > 0; --i) loose(bag(set_, d_));
    for (int i = n(3); i > 0; --i) loose(d_.chance(0.5f) ? a_chair() : stool(set_, d_));
    const bool messy = d_.chance(0.25f);
    for (int i = messy ? n(20) : 0; i > 0; --i) {
      const Rect& r = plan_.rects[0];
      const Frame f = turned(d_.range(-3, 3), {d_.range(r.x0 + 0.2f, r.x1 - 0.2f), 0,
                                               d_.range(r.z0 + 0.2f, r.z1 - 0.2f)});
      if (!free(bounds_of(f, 0.3f, 0.3f), 0, 0.3f)) continue;
      if (wants_model(set_, d_) && model_clutter(set_, d_, f, 0.5f, 0.5f, 0.5f)) continue;
      clutter(set_, d_, set_.solid(f), 0.4f, 0.4f, 0.4f);
    }
  }
};

}  // namespace

void furnish_space(Set& set, const Plan& plan, bool main) { Furnisher(set, plan).furnish(main); }

}  // namespace ps::rooms
