// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/cloud_intervals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>

#include "libps/core/error.h"
#include "libps/eval/cloud_metrics.h"

namespace ps {
namespace {

/// What one cloud has in a block, or in some.
struct Part {
  double points = 0, metres = 0;
  std::vector<double> near;  ///< points nearer to the other cloud than each threshold

  void add(const Part& other) {
    points += other.points, metres += other.metres;
    near.resize(other.near.size());
    for (std::size_t k = 0; k < near.size(); ++k) near[k] += other.near[k];
  }
  double share(std::size_t k) const { return near[k] / points; }
};

struct Block {
  Part ours, theirs;
};

/// Blocks by place.
class Blocks {
 public:
  Blocks(std::vector<double> thresholds, double side)
      : thresholds_(std::move(thresholds)), side_(side) {}

  /// @param part  which of a block's two the cloud is
  void add(const Cloud& cloud, const std::vector<double>& metres, Part Block::*part) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (std::isnan(metres[i])) continue;
      Part& to = of(cloud[i]).*part;
      ++to.points;
      to.metres += metres[i];
      for (std::size_t k = 0; k < thresholds_.size(); ++k) to.near[k] += metres[i] < thresholds_[k];
    }
  }
  /// In the order of their places, whatever that of the points.
  std::vector<Block> take() {
    std::vector<Block> all;
    for (auto& [place, block] : blocks_) all.push_back(std::move(block));
    return all;
  }

 private:
  Block& of(const Point& point) {
    const auto place = [&](float x) { return std::floor(x / side_); };
    Block& block = blocks_[{place(point.x), place(point.y), place(point.z)}];
    block.ours.near.resize(thresholds_.size());
    block.theirs.near.resize(thresholds_.size());
    return block;
  }

  std::vector<double> thresholds_;
  double side_;
  std::map<std::array<double, 3>, Block> blocks_;
};

double f_score(double accuracy, double completeness) {
  const double sum = accuracy + completeness;
  return sum > 0 ? 2 * accuracy * completeness / sum : sum;  // NaN stays
}

std::vector<Block> blocks_of(const Cloud& cloud, const Cloud& truth,
                             const std::vector<double>& thresholds, double side) {
  Blocks blocks(thresholds, side);
  blocks.add(cloud, nearest_distances(cloud, truth), &Block::ours);
  blocks.add(truth, nearest_distances(truth, cloud), &Block::theirs);
  return blocks.take();
}

/// Of an empty cloud.
CloudIntervals nothing(const std::vector<double>& thresholds) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  CloudIntervals result;
  const Interval none = {0, kNan, kNan, 0};
  for (const double threshold : thresholds) result.scores.push_back({threshold, none, none, none});
  result.chamfer = {kNan, kNan, kNan, 0};
  return result;
}

}  // namespace

CloudIntervals cloud_intervals(const Cloud& cloud, const Cloud& truth,
                               const std::vector<double>& thresholds, double block,
                               const BootstrapOptions& options) {
  if (!(block > 0) || !std::isfinite(block)) {
    throw Error("cloud_intervals", "a block of " + std::to_string(block), "metres above 0");
  }
  cloud_scores({}, {}, thresholds);  // checks them
  const std::vector<Block> blocks = blocks_of(cloud, truth, thresholds, block);
  const auto has = [&](Part Block::*part) {
    return std::any_of(blocks.begin(), blocks.end(),
                       [&](const Block& b) { return (b.*part).points > 0; });
  };
  if (!has(&Block::ours) || !has(&Block::theirs)) return nothing(thresholds);

  // Of a figure of what both clouds have in some blocks.
  const auto interval = [&](const auto& figure) {
    const auto of_blocks = [&](const std::vector<std::size_t>& drawn) {
      Block some;
      for (const std::size_t i : drawn) {
        some.ours.add(blocks[i].ours);
        some.theirs.add(blocks[i].theirs);
      }
      return figure(some.ours, some.theirs);
    };
    return bootstrap(blocks.size(), of_blocks, options);
  };
  CloudIntervals result;
  for (std::size_t k = 0; k < thresholds.size(); ++k) {
    result.scores.push_back(
        {thresholds[k], interval([k](const Part& ours, const Part&) { return ours.share(k); }),
         interval([k](const Part&, const Part& theirs) { return theirs.share(k); }),
         interval([k](const Part& ours, const Part& theirs) {
           return f_score(ours.share(k), theirs.share(k));
         })});
  }
  result.chamfer = interval([](const Part& ours, const Part& theirs) {
    return (ours.metres / ours.points + theirs.metres / theirs.points) / 2;
  });
  return result;
}

}  // namespace ps
