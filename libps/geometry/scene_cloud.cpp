// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/scene_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/geometry/cloud_store.h"
#include "libps/geometry/view_match.h"

namespace ps {
namespace {

constexpr float kNearest = 1e-3f;  ///< metres; nearer pixels are no surface (SplatOptions::near)

void check(const SceneCloudOptions& o) {
  const bool sound = o.tolerance_relative >= 0 && o.tolerance_footprints >= 0 &&
                     o.spacing_footprints >= 0 && o.spacing >= 0 && o.better_footprint >= 0 &&
                     o.better_footprint <= 1 && o.lift.min_depth <= o.lift.max_depth &&
                     o.lift.edge_footprints >= 0;
  if (!sound) {
    throw Error(
        "scene cloud options", "one is out of range",
        "tolerances, spacings and edge_footprints of at least 0, better_footprint in [0, 1], "
        "min_depth <= max_depth");
  }
}

/// Points are kept in single precision: refuses views whose pixels it could not tell apart.
void check_precision(const View& view, const Mask& usable, const std::string& where) {
  double farthest = 0;
  cv::minMaxLoc(view.depth, nullptr, &farthest, nullptr, nullptr, usable);
  const double place = view.world_from_cam.translation().cwiseAbs().maxCoeff() + farthest;
  const double finest = std::numeric_limits<float>::epsilon() * place;
  if (farthest > 0 && view.intrinsics.footprint_per_metre() * farthest < 2 * finest) {
    throw Error(where, "its pixels are nearer to each other than single precision can tell apart",
                "poses near the origin, in metres, and focal lengths in pixels");
  }
}

}  // namespace

struct SceneCloud::Impl {
  SceneCloudOptions options;
  CloudStore store;
  std::size_t gone = 0;
};

SceneCloud::SceneCloud(const SceneCloudOptions& options) : impl_(std::make_unique<Impl>()) {
  check(options);
  impl_->options = options;
}
SceneCloud::~SceneCloud() = default;
SceneCloud::SceneCloud(SceneCloud&&) noexcept = default;
SceneCloud& SceneCloud::operator=(SceneCloud&&) noexcept = default;

AddReport SceneCloud::add(const View& view, std::uint16_t view_number, Origin origin,
                          const Mask& pixels) {
  check(view, "view " + std::to_string(view_number));
  LiftOptions options = impl_->options.lift;
  if (origin == Origin::outpainted) options.estimated = true;
  Mask usable = liftable(view.depth, view.intrinsics, options);
  if (!pixels.empty()) {
    if (pixels.size() != usable.size()) {
      throw Error("view " + std::to_string(view_number), "mask and photo differ in size",
                  "one size");
    }
    usable.setTo(0, pixels == 0);
  }
  usable.setTo(0, view.depth < kNearest);
  check_precision(view, usable, "view " + std::to_string(view_number));
  AddReport report;
  report.lifted = cv::countNonZero(usable);

  const ViewMatch match(impl_->store, view, usable, origin, impl_->options);
  report.replaced = match.removed();
  impl_->gone += report.replaced;
  Mask unexplained = match.unexplained();
  const std::size_t candidates = cv::countNonZero(unexplained);
  report.explained = report.lifted - candidates;
  match.drop_near_neighbours(&unexplained);

  const Cloud added = lift(view, unexplained, view_number, origin);
  std::size_t next = 0;
  for (int y = 0; y < unexplained.rows; ++y) {
    for (int x = 0; x < unexplained.cols; ++x) {
      if (!unexplained(y, x)) continue;
      const Point& point = added[next++];
      const cv::Vec3f c = view.color(y, x);
      impl_->store.add(point, {view_weight(point.footprint), c[0], c[1], c[2]});
    }
  }
  report.added = added.size();
  report.duplicates = candidates - report.added;
  return report;
}

std::size_t SceneCloud::remove_contradicted() {
  std::size_t removed = 0;
  for (CloudCell& cell : impl_->store.cells()) {
    for (std::size_t i = 0; i < cell.points.size(); ++i) {
      const Evidence& evidence = cell.evidence[i];
      if (!CloudStore::alive(cell.points[i]) || evidence.seen_through < evidence.seen) continue;
      cell.points[i].footprint = 0;
      ++removed;
    }
  }
  impl_->gone += removed;
  return removed;
}

Cloud SceneCloud::cloud() const {
  const CloudStore& store = impl_->store;
  // Each number's place in the result: points in the order in which they were added.
  std::vector<std::uint32_t> place(store.numbers() + 1, 0);
  for (const CloudCell& cell : store.cells()) {
    for (std::size_t i = 0; i < cell.points.size(); ++i) {
      place[cell.evidence[i].number + 1] = CloudStore::alive(cell.points[i]);
    }
  }
  std::partial_sum(place.begin(), place.end(), place.begin());
  Cloud result;
  result.resize(place.back());
  parallel_for(store.cells().size(), [&](std::size_t c) {
    const CloudCell& cell = store.cells()[c];
    for (std::size_t i = 0; i < cell.points.size(); ++i) {
      if (!CloudStore::alive(cell.points[i])) continue;
      const Evidence& e = cell.evidence[i];
      Point& point = result[place[e.number]];
      point = cell.points[i];
      point.r = to_byte(e.r);
      point.g = to_byte(e.g);
      point.b = to_byte(e.b);
    }
  });
  return result;
}

std::size_t SceneCloud::size() const { return impl_->store.numbers() - impl_->gone; }

}  // namespace ps
