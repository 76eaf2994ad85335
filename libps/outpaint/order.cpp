// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/order.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <queue>
#include <tuple>

#include "libps/core/error.h"

namespace ps::outpaint {
namespace {

constexpr int kTaps = 9;

/// OpenCV's chamfer distance from the cells that are set to the nearest that is not.
cv::Mat1f inner_distance(const cv::Mat1b& set) {
  cv::Mat1f distance;
  cv::distanceTransform(set, distance, cv::DIST_L2, cv::DIST_MASK_5);
  return distance;
}

/// Which cells are all foreground, and which all background.
std::pair<cv::Mat1b, cv::Mat1b> whole_cells(const cv::Mat1b& background, int cell) {
  const cv::Size grid(background.cols / cell, background.rows / cell);
  cv::Mat1b foreground_cells(grid), background_cells(grid);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const int count = cv::countNonZero(background(cv::Rect(x * cell, y * cell, cell, cell)));
      foreground_cells(y, x) = count == 0;
      background_cells(y, x) = count == cell * cell;
    }
  }
  return {foreground_cells, background_cells};
}

/// From the cell of greatest distance, always on to the greatest of those that touch what is
/// ordered.
std::vector<int> grow(const std::vector<int>& distance, int height, int width) {
  const auto cells = static_cast<int>(distance.size());
  using Candidate = std::tuple<int, int>;  // distance, then -cell: the smaller cell first
  std::priority_queue<Candidate> border;
  std::vector<bool> reached(distance.size(), false);
  const auto reach = [&](int y, int x) {
    if (y < 0 || y >= height || x < 0 || x >= width) return;
    const int cell = y * width + x;
    if (reached[static_cast<std::size_t>(cell)]) return;
    reached[static_cast<std::size_t>(cell)] = true;
    border.emplace(distance[static_cast<std::size_t>(cell)], -cell);
  };
  int first = 0;
  for (int i = 1; i < cells; ++i) {
    if (distance[static_cast<std::size_t>(i)] > distance[static_cast<std::size_t>(first)])
      first = i;
  }
  std::vector<int> order;
  if (cells > 0) reach(first / width, first % width);
  while (!border.empty()) {
    const int cell = -std::get<1>(border.top());
    border.pop();
    order.push_back(cell);
    const int y = cell / width, x = cell % width;
    reach(y - 1, x);
    reach(y + 1, x);
    reach(y, x - 1);
    reach(y, x + 1);
  }
  return order;
}

std::vector<std::uint8_t> local_mask(const Order& order, int dilation, bool centre) {
  const std::size_t cells = order.size();
  std::vector<std::uint8_t> mask(kTaps * cells, 0);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    for (int tap = 0; tap < kTaps; ++tap) {
      const int y = static_cast<int>(cell) / order.width + (tap / 3 - 1) * dilation;
      const int x = static_cast<int>(cell) % order.width + (tap % 3 - 1) * dilation;
      if (y < 0 || y >= order.height || x < 0 || x >= order.width) continue;
      const auto other = static_cast<std::size_t>(y * order.width + x);
      const bool visible = tap == kTaps / 2 ? centre : order.rank[other] < order.rank[cell];
      mask[static_cast<std::size_t>(tap) * cells + cell] = visible;
    }
  }
  return mask;
}

}  // namespace

Order order_from(int height, int width, std::vector<int> cells, std::vector<std::uint8_t> missing) {
  const auto count = static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  Order order;
  order.height = height;
  order.width = width;
  order.rank.assign(count, -1);
  if (cells.size() != count || missing.size() != count) {
    throw Error(
        "order",
        std::to_string(cells.size()) + " cells and " + std::to_string(missing.size()) + " marks",
        std::to_string(count) + " of each");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const int cell = cells[i];
    if (cell < 0 || static_cast<std::size_t>(cell) >= count ||
        order.rank[static_cast<std::size_t>(cell)] >= 0) {
      throw Error("order", "cell " + std::to_string(cell) + " at place " + std::to_string(i),
                  "every cell of the grid once");
    }
    order.rank[static_cast<std::size_t>(cell)] = static_cast<int>(i);
  }
  order.cells = std::move(cells);
  order.missing = std::move(missing);
  order.masks = {local_mask(order, 1, false), local_mask(order, 1, true),
                 local_mask(order, 2, true)};
  return order;
}

Order order_of(const cv::Mat1b& background, int cell) {
  if (cell < 1 || background.empty() || background.rows % cell || background.cols % cell) {
    throw Error("background mask",
                std::to_string(background.cols) + "x" + std::to_string(background.rows),
                "sides that are multiples of " + std::to_string(cell));
  }
  const auto [foreground, missing] = whole_cells(background, cell);
  const cv::Mat1f inside = inner_distance(foreground), outside = inner_distance(missing);
  std::vector<int> distance;
  for (int y = 0; y < foreground.rows; ++y) {
    for (int x = 0; x < foreground.cols; ++x) {
      distance.push_back(static_cast<int>(std::trunc(inside(y, x) - outside(y, x))));
    }
  }
  Order order =
      order_from(foreground.rows, foreground.cols, grow(distance, foreground.rows, foreground.cols),
                 std::vector<std::uint8_t>(missing.begin(), missing.end()));
  order.distance = std::move(distance);
  return order;
}

}  // namespace ps::outpaint
