// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/tree.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "libps/rooms/four.h"
#include "libps/rooms/isa.h"

namespace ps::rooms {
namespace {

constexpr int kBins = 16;
constexpr int kLargestLeaf = 4;  ///< triangles
constexpr int kDeepest = 56;     ///< the kernel's stack holds 64

struct Box {
  Four low = four(1e30f), high = four(-1e30f);

  void add(Four p) {
    low = min(low, p);
    high = max(high, p);
  }
  void add(const Box& b) {
    low = min(low, b.low);
    high = max(high, b.high);
  }
  float half_area() const {
    const Four d = high - low;
    return d[0] < 0 ? 0 : d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

struct Item {
  Box box;
  Four center;
  std::uint32_t face;
};

struct Split {
  int axis = -1;
  float place = 0;
};

/// Items by where their centres lie between `low` and `low + extent`, along each axis.
struct Bins {
  Box boxes[3][kBins];
  int counts[3][kBins] = {};

  Bins(const Item* items, int count, Four low, Four extent) {
    const Four safe = extent > 1e-6f ? extent : four(1);
    for (int i = 0; i < count; ++i) {
      const Four place = (items[i].center - low) / safe * static_cast<float>(kBins);
      for (int axis = 0; axis < 3; ++axis) {
        const int bin = std::min(kBins - 1, static_cast<int>(place[axis]));
        boxes[axis][bin].add(items[i].box);
        ++counts[axis][bin];
      }
    }
  }
};

/// The cheapest of the planes between bins, over the three axes.
Split best_split(const Item* items, int count, const Box& centers) {
  const Four extents = centers.high - centers.low;
  const Bins bins(items, count, centers.low, extents);
  Split best;
  float best_cost = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const float low = centers.low[axis], extent = extents[axis];
    if (!(extent > 1e-6f)) continue;
    const Box* boxes = bins.boxes[axis];
    const int* counts = bins.counts[axis];
    float right_cost[kBins];
    Box right;
    int right_count = 0;
    for (int b = kBins - 1; b > 0; --b) {
      right.add(boxes[b]);
      right_count += counts[b];
      right_cost[b] = right.half_area() * static_cast<float>(right_count);
    }
    Box left;
    int left_count = 0;
    for (int b = 1; b < kBins; ++b) {
      left.add(boxes[b - 1]);
      left_count += counts[b - 1];
      if (left_count == 0 || left_count == count) continue;
      const float cost = left.half_area() * static_cast<float>(left_count) + right_cost[b];
      if (cost < best_cost) {
        best_cost = cost;
        best = {axis, low + extent * static_cast<float>(b) / kBins};
      }
    }
  }
  return best;
}

class Builder {
 public:
  Builder(std::vector<Item>& items, std::vector<Tree::Pair>& pairs, int leaf)
      : items_(items), pairs_(pairs), leaf_(leaf) {}

  void build() {
    pairs_.resize(1);
    build(0, 0, static_cast<int>(items_.size()), 0);
  }

 private:
  TraceNode& at(std::uint32_t node) { return pairs_[node / 2].nodes[node % 2]; }

  void build(std::uint32_t node, int begin, int end, int depth) {
    Box box, centers;
    for (int i = begin; i < end; ++i) {
      box.add(items_[i].box);
      centers.add(items_[i].center);
    }
    TraceNode n{{box.low[0], box.low[1], box.low[2]},
                {box.high[0], box.high[1], box.high[2]},
                static_cast<std::uint32_t>(begin),
                static_cast<std::uint16_t>(end - begin),
                0};
    int middle = begin;
    if (end - begin > leaf_ && depth < kDeepest) middle = split(begin, end, centers, n.axis);
    if (middle == begin && end - begin > 0xffff) middle = (begin + end) / 2;
    if (middle > begin) {
      n.first = static_cast<std::uint32_t>(2 * pairs_.size());
      n.count = 0;
    }
    at(node) = n;
    if (middle == begin) return;
    pairs_.emplace_back();
    build(n.first, begin, middle, depth + 1);
    build(n.first + 1, middle, end, depth + 1);
  }

  /// @return where the second half begins; `begin` if all are in one place
  int split(int begin, int end, const Box& centers, std::uint16_t& axis) {
    const Split best = best_split(&items_[begin], end - begin, centers);
    if (best.axis < 0) return begin;
    axis = static_cast<std::uint16_t>(best.axis);
    const auto middle =
        std::partition(items_.begin() + begin, items_.begin() + end,
                       [&](const Item& item) { return item.center[best.axis] < best.place; });
    const int found = static_cast<int>(middle - items_.begin());
    return found == end ? begin : found;
  }

  std::vector<Item>& items_;
  std::vector<Tree::Pair>& pairs_;
  int leaf_;
};

}  // namespace

Tree::Tree(const Mesh& mesh) {
  std::vector<Item> items;
  items.reserve(mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    Item item;
    for (const std::uint32_t c : mesh.faces[f].corners)
      item.box.add(four(mesh.corners[c].position));
    item.center = (item.box.low + item.box.high) * 0.5f;
    // Boxes of flat things must not be lost to rounding.
    item.box.low -= 1e-5f;
    item.box.high += 1e-5f;
    item.face = f;
    items.push_back(item);
  }
  if (items.empty()) return;
  pairs.reserve(items.size() / 2 + 1);
  Builder(items, pairs, kLargestLeaf).build();
  triangles.reserve(items.size());
  for (const Item& item : items) {
    const auto& c = mesh.faces[item.face].corners;
    const Vec p = mesh.corners[c[0]].position;
    const Vec a = mesh.corners[c[1]].position - p, b = mesh.corners[c[2]].position - p;
    triangles.push_back({{p.x, p.y, p.z}, {a.x, a.y, a.z}, {b.x, b.y, b.z}, item.face});
  }
}

Tree::Tree(const std::vector<std::array<Vec, 2>>& boxes) {
  std::vector<Item> items;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const Four low = four(boxes[i][0]), high = four(boxes[i][1]);
    items.push_back({{low, high}, (low + high) * 0.5f, i});
  }
  if (items.empty()) return;
  Builder(items, pairs, 1).build();
  for (const Item& item : items) triangles.push_back({{}, {}, {}, item.face});
}

void enter(const trace_kernel::Axes& axes, const Rays& rays, Rays& local) {
  PS_FITTING(trace_kernel::enter)(axes, rays, local);
}

void nearest(const Tree& tree, int part, Rays& rays) {
  if (tree.empty()) return;
  PS_FITTING(trace_kernel::nearest)(tree.root(), tree.triangles.data(), part, &rays);
}

void blocked(const Tree& tree, Rays& rays) {
  if (tree.empty()) return;
  PS_FITTING(trace_kernel::blocked)(tree.root(), tree.triangles.data(), &rays);
}

int reached(const Tree& tree, const Rays& rays, std::uint32_t* out) {
  if (tree.empty()) return 0;
  return PS_FITTING(trace_kernel::reached)(tree.root(), tree.triangles.data(), &rays, out);
}

}  // namespace ps::rooms
