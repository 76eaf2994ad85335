// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr std::size_t kRowsAtATime = 16;
const std::string kWhere = "in_free_space";

bool known(float depth) { return depth > 0 && std::isfinite(depth); }

Pose checked_camera(const View& view) {
  check(view.intrinsics, kWhere);
  if (view.depth.size() != cv::Size(view.intrinsics.width, view.intrinsics.height)) {
    throw Error(kWhere, "a view's depth and intrinsics differ in size", "one size");
  }
  return checked_pose(view.world_from_cam.matrix(), kWhere);
}

/// What an observed view says of points.
class Witness {
 public:
  Witness(const View& observed, const Pose& world_from_view, const FreeSpaceOptions& options)
      : camera_(observed.intrinsics),
        observed_from_view_(checked_camera(observed).inverse() * world_from_view) {
    Depth depth(observed.depth.size());
    for (int y = 0; y < depth.rows; ++y) {
      for (int x = 0; x < depth.cols; ++x) {
        const float d = observed.depth(y, x);
        depth(y, x) = known(d) ? d : std::numeric_limits<float>::max();
      }
    }
    cv::erode(depth, free_, cv::Mat1b(3, 3, 1));
    const double tolerance =
        options.tolerance_relative + options.tolerance_footprints * camera_.footprint_per_metre();
    const auto kept = static_cast<float>(1 - tolerance);
    for (float& d : free_) d = d < std::numeric_limits<float>::max() ? d * kept : 0;
  }

  /// @return true where it looked through the point at what is behind
  bool contradicts(const Eigen::Vector3d& point_in_view) const {
    const Eigen::Vector3d p = observed_from_view_ * point_in_view;
    if (!(p.z() > 0)) return false;
    const Eigen::Vector2d at = camera_.project(p) + Eigen::Vector2d(0.5, 0.5);
    const bool inside =
        at.x() >= 0 && at.y() >= 0 && at.x() < camera_.width && at.y() < camera_.height;
    return inside && p.z() < free_(static_cast<int>(at.y()), static_cast<int>(at.x()));
  }

 private:
  Intrinsics camera_;
  Pose observed_from_view_;
  Depth free_;  ///< metres along each pixel's ray that are certainly free; 0 where nothing is known
};

}  // namespace

Mask in_free_space(const View& view, const Mask& pixels, const std::vector<View>& observed,
                   const FreeSpaceOptions& options) {
  if (!(options.tolerance_relative >= 0 && options.tolerance_footprints >= 0)) {
    throw Error(kWhere, "a tolerance is negative", "0 or more");
  }
  const Pose world_from_view = checked_camera(view);
  if (pixels.size() != view.depth.size()) {
    throw Error(kWhere, "pixels and view differ in size", "one size");
  }
  std::vector<Witness> witnesses;
  for (const View& o : observed) witnesses.emplace_back(o, world_from_view, options);
  Mask result = Mask::zeros(pixels.size());
  parallel_chunks(pixels.rows, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < pixels.cols; ++x) {
        if (!pixels(y, x) || !known(view.depth(y, x))) continue;
        const Eigen::Vector3d point = view.intrinsics.lift(x, y, view.depth(y, x));
        const bool contradicted =
            std::any_of(witnesses.begin(), witnesses.end(),
                        [&](const Witness& w) { return w.contradicts(point); });
        result(y, x) = static_cast<std::uint8_t>(contradicted);
      }
    }
  });
  return result;
}

}  // namespace ps
