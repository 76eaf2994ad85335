// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/plan.h"

#include <algorithm>

namespace ps::outpaint {
namespace {

constexpr int kTaps = 9;

/// The cell that a tap looks at, or -1 where its mask hides it.
int neighbour(const Order& order, const std::vector<std::uint8_t>& mask, int cell, int tap,
              int dilation) {
  if (!mask[static_cast<std::size_t>(tap) * order.size() + static_cast<std::size_t>(cell)])
    return -1;
  return cell + (tap / 3 - 1) * dilation * order.width + (tap % 3 - 1) * dilation;
}

/// Calls visit(other) for all other cells that a cell looks at.
template <class Visit>
void for_each_seen(const Order& order, int cell, const Visit& visit) {
  for (int tap = 0; tap < kTaps; ++tap) {
    if (tap == kTaps / 2) continue;
    const int near = neighbour(order, order.masks.later, cell, tap, 1);
    const int far = neighbour(order, order.masks.dilated, cell, tap, 2);
    if (near >= 0) visit(static_cast<std::size_t>(near));
    if (far >= 0) visit(static_cast<std::size_t>(far));
  }
}

/// Missing cells, and all that these look at, directly or through others.
std::vector<bool> needed_cells(const Order& order) {
  std::vector<bool> needed(order.missing.begin(), order.missing.end());
  for (auto cell = order.cells.rbegin(); cell != order.cells.rend(); ++cell) {
    if (!needed[static_cast<std::size_t>(*cell)]) continue;
    for_each_seen(order, *cell, [&](std::size_t other) { needed[other] = true; });
  }
  return needed;
}

/// 0 = shared, else one more than the greatest level that the cell looks at; a missing cell counts
/// as 1 at least for those that look at it.
std::vector<int> levels_of(const Order& order) {
  std::vector<int> level(order.size(), 0);
  for (const int cell : order.cells) {
    for_each_seen(order, cell, [&](std::size_t other) {
      const bool varies = order.missing[other] || level[other] > 0;
      if (varies) {
        level[static_cast<std::size_t>(cell)] =
            std::max(level[static_cast<std::size_t>(cell)], level[other] + 1);
      }
    });
  }
  return level;
}

void complete(const Order& order, Group& group) {
  const auto is_missing = [&](int cell) {
    return order.missing[static_cast<std::size_t>(cell)] != 0;
  };
  const auto known = std::stable_partition(group.cells.begin(), group.cells.end(), is_missing);
  group.missing = static_cast<std::size_t>(known - group.cells.begin());
  for (const int cell : group.cells) {
    for (int tap = 0; tap < kTaps; ++tap) {
      group.near.push_back(neighbour(order, order.masks.later, cell, tap, 1));
      group.far.push_back(neighbour(order, order.masks.dilated, cell, tap, 2));
    }
  }
}

/// By level: the last level that looks at it.
std::vector<std::size_t> last_readers(const std::vector<Group>& levels, std::size_t cells) {
  constexpr std::size_t kShared = ~std::size_t{0};
  std::vector<std::size_t> level_of(cells, kShared), last(levels.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    last[i] = i;
    for (const int cell : levels[i].cells) level_of[static_cast<std::size_t>(cell)] = i;
    for (const auto* seen : {&levels[i].near, &levels[i].far}) {
      for (const int cell : *seen) {
        const std::size_t level = cell < 0 ? kShared : level_of[static_cast<std::size_t>(cell)];
        if (level != kShared) last[level] = i;
      }
    }
  }
  return last;
}

/// Gives each level the first run of places that nothing else needs while it is needed.
/// @return how many places that takes
std::size_t place_levels(std::vector<Group>& levels, std::size_t cells) {
  struct Taken {
    std::size_t begin, end, until;
  };
  const std::vector<std::size_t> last = last_readers(levels, cells);
  std::vector<Taken> taken;  // rising
  std::size_t places = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    taken.erase(std::remove_if(taken.begin(), taken.end(),
                               [&](const Taken& other) { return other.until < i; }),
                taken.end());
    const std::size_t count = levels[i].cells.size();
    std::size_t begin = 0;
    auto before = taken.begin();
    for (; before != taken.end() && before->begin < begin + count; ++before) begin = before->end;
    taken.insert(before, {begin, begin + count, last[i]});
    levels[i].first = begin;
    places = std::max(places, begin + count);
  }
  return places;
}

}  // namespace

Plan::Plan(const Order& order) : place(order.size(), -1), is_shared(order.size(), 0) {
  const std::vector<bool> needed = needed_cells(order);
  const std::vector<int> level = levels_of(order);
  for (const int cell : order.cells) {
    const auto at = static_cast<std::size_t>(cell);
    if (!needed[at]) continue;
    is_shared[at] = level[at] == 0;
    const auto index = static_cast<std::size_t>(level[at]);
    if (levels.size() < index) levels.resize(index);
    (index == 0 ? shared : levels[index - 1]).cells.push_back(cell);
  }
  levels.erase(std::remove_if(levels.begin(), levels.end(),
                              [](const Group& group) { return group.cells.empty(); }),
               levels.end());
  complete(order, shared);
  for (Group& group : levels) complete(order, group);
  lane_places = place_levels(levels, order.size());
  const auto number = [&](const Group& group) {
    auto next = static_cast<int>(group.first);
    for (const int cell : group.cells) place[static_cast<std::size_t>(cell)] = next++;
  };
  number(shared);
  for (const Group& group : levels) number(group);
}

}  // namespace ps::outpaint
