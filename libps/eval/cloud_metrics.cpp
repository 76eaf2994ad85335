// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/cloud_metrics.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr std::size_t kChunk = 4096;

using Positions = pcl::PointCloud<pcl::PointXYZ>;

Positions finite_positions(const Cloud& cloud) {
  Positions positions;
  positions.reserve(cloud.size());
  for (const Point& point : cloud) {
    if (std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z)) {
      positions.emplace_back(point.x, point.y, point.z);
    }
  }
  return positions;
}

double distance(const pcl::PointXYZ& a, const pcl::PointXYZ& b) {
  return std::hypot(static_cast<double>(a.x) - b.x, static_cast<double>(a.y) - b.y,
                    static_cast<double>(a.z) - b.z);
}

/// Each position once: FLANN's tree visits every copy of the nearest point, so that a cloud with
/// many coincident points would cost the square of their number.
Positions::Ptr distinct(const Positions& positions) {
  auto result = std::make_shared<Positions>(positions);
  const auto key = [](const pcl::PointXYZ& p) { return std::tie(p.x, p.y, p.z); };
  std::sort(result->begin(), result->end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  result->erase(std::unique(result->begin(), result->end(),
                            [&](const auto& a, const auto& b) { return key(a) == key(b); }),
                result->end());
  return result;
}

/// Exact nearest neighbours; the tree may be asked by several threads at once.
class NearestPoint {
 public:
  explicit NearestPoint(const Positions& points) : points_(distinct(points)), tree_(false) {
    tree_.setInputCloud(points_);
  }

  /// @return metres from the query to the nearest point; infinite when none is nearer than `bound`
  double operator()(const pcl::PointXYZ& query, double bound) const {
    static thread_local pcl::Indices index(1);
    static thread_local std::vector<float> square(1);
    const int found = std::isfinite(bound) ? tree_.radiusSearch(query, bound, index, square, 1)
                                           : tree_.nearestKSearch(query, 1, index, square);
    // The tree's own distance is a rounded square: good for finding, not for measuring.
    return found > 0 ? distance(query, (*points_)[index[0]])
                     : std::numeric_limits<double>::infinity();
  }

 private:
  Positions::ConstPtr points_;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree_;
};

/// For each threshold, how many of `from` are nearer than that to a point of `to`.
std::vector<std::size_t> count_near(const Positions& from, const Positions& to,
                                    const std::vector<double>& thresholds) {
  const NearestPoint nearest(to);
  // Beyond the largest threshold nothing needs to be known; the margin covers the tree's rounding.
  const double bound = 1.001 * *std::max_element(thresholds.begin(), thresholds.end());
  std::vector<std::vector<std::size_t>> counts((from.size() + kChunk - 1) / kChunk,
                                               std::vector<std::size_t>(thresholds.size(), 0));
  parallel_chunks(from.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::vector<std::size_t>& count = counts[begin / kChunk];
    for (std::size_t i = begin; i < end; ++i) {
      const double metres = nearest(from[i], bound);
      for (std::size_t k = 0; k < thresholds.size(); ++k) count[k] += metres < thresholds[k];
    }
  });
  std::vector<std::size_t> total(thresholds.size(), 0);
  for (const auto& count : counts) {
    for (std::size_t k = 0; k < total.size(); ++k) total[k] += count[k];
  }
  return total;
}

double mean_distance(const Positions& from, const Positions& to) {
  const NearestPoint nearest(to);
  std::vector<double> sums((from.size() + kChunk - 1) / kChunk, 0);
  parallel_chunks(from.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      sums[begin / kChunk] += nearest(from[i], std::numeric_limits<double>::infinity());
    }
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(from.size());
}

}  // namespace

std::vector<CloudScore> cloud_scores(const Cloud& cloud, const Cloud& truth,
                                     const std::vector<double>& thresholds) {
  std::vector<CloudScore> scores(thresholds.size());
  for (std::size_t k = 0; k < thresholds.size(); ++k) {
    if (!std::isfinite(thresholds[k]) || thresholds[k] <= 0) {
      throw Error("cloud_scores", "a threshold is " + std::to_string(thresholds[k]),
                  "metres above 0");
    }
    scores[k].threshold = thresholds[k];
  }
  const Positions ours = finite_positions(cloud);
  const Positions theirs = finite_positions(truth);
  if (thresholds.empty() || ours.empty() || theirs.empty()) return scores;

  const std::vector<std::size_t> accurate = count_near(ours, theirs, thresholds);
  const std::vector<std::size_t> complete = count_near(theirs, ours, thresholds);
  for (std::size_t k = 0; k < scores.size(); ++k) {
    CloudScore& score = scores[k];
    score.accuracy = static_cast<double>(accurate[k]) / static_cast<double>(ours.size());
    score.completeness = static_cast<double>(complete[k]) / static_cast<double>(theirs.size());
    const double sum = score.accuracy + score.completeness;
    score.f_score = sum > 0 ? 2 * score.accuracy * score.completeness / sum : 0;
  }
  return scores;
}

double chamfer_distance(const Cloud& a, const Cloud& b) {
  const Positions first = finite_positions(a);
  const Positions second = finite_positions(b);
  if (first.empty() || second.empty()) return std::numeric_limits<double>::quiet_NaN();
  return (mean_distance(first, second) + mean_distance(second, first)) / 2;
}

std::vector<double> nearest_distances(const Cloud& from, const Cloud& to) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> metres(from.size(), std::numeric_limits<double>::quiet_NaN());
  const Positions theirs = finite_positions(to);
  const std::optional<NearestPoint> nearest =
      theirs.empty() ? std::nullopt : std::make_optional<NearestPoint>(theirs);
  parallel_chunks(from.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Point& p = from[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
      metres[i] = nearest ? (*nearest)({p.x, p.y, p.z}, kInfinity) : kInfinity;
    }
  });
  return metres;
}

double share_in_front(const Cloud& cloud, Origin origin, const View& seen) {
  constexpr double kTolerance = 0.01;
  const Pose cam_from_world = seen.world_from_cam.inverse();
  std::size_t all = 0, before = 0;
  for (const Point& point : cloud) {
    if (static_cast<Origin>(point.origin) != origin) continue;
    ++all;
    const Eigen::Vector3d p = cam_from_world * point.getVector3fMap().cast<double>();
    if (!(p.z() > 0)) continue;
    const Eigen::Vector2d at = seen.intrinsics.project(p);
    const double x = std::round(at.x()), y = std::round(at.y());
    if (!(x >= 0 && y >= 0 && x < seen.depth.cols && y < seen.depth.rows)) continue;
    const double surface = seen.depth(static_cast<int>(y), static_cast<int>(x));
    before += surface > 0 && p.z() < (1 - kTolerance) * surface;
  }
  if (all == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(before) / static_cast<double>(all);
}

}  // namespace ps
