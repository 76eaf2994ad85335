// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "libps/core/image.h"
#include "libps/geometry/camera.h"
#include "libps/geometry/splat.h"
#include "libps/models/refiner.h"

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace ps {

struct Point;

struct ViewRendererOptions {
  SplatOptions splat;          ///< what the refiner is given; its background is set to grey
  float detail_radius = 1.5f;  ///< pixels of the view; of the splats that give the detail
  /// Standard deviation, in the networks' pixels, of what is taken from the refiner where the cloud
  /// is seen; what is finer comes from the cloud. 0 = the refiner's picture alone, as published.
  double detail_from = 2;
  std::uint64_t seed = 0;  ///< of the refiner's noise, which is the same for all views
};

struct RenderedView {
  Image color;               ///< [0,1], of the lens's size
  Splat splat;               ///< of the cloud into this lens, with detail_radius
  double missing_share = 0;  ///< of the networks' view: what the refiner alone had to fill in
};

/// @brief Any view of a scene's cloud: splat and refinement (SPEC.md 1). The networks see 256
/// pixels along the short side; where the cloud is seen, what is finer than they can tell comes
/// from the cloud itself, splatted at the view's full size. Not for two threads at once.
class ViewRenderer {
 public:
  /// @param refiner  must outlive this; null = no network: the splat alone, renormalised, of
  /// radius options.splat.radius
  explicit ViewRenderer(const models::Refiner* refiner, const ViewRendererOptions& options = {});

  /// Throws ps::Error when lens or pose are unsound, or the refiner gives what is not finite.
  RenderedView render(const pcl::PointCloud<Point>& cloud, const Intrinsics& lens,
                      const Pose& world_from_cam);

 private:
  Image refined(const Splat& seen);

  const models::Refiner* refiner_;
  ViewRendererOptions options_;
  std::vector<float> noise_;
  nn::Workspace workspace_;
};

}  // namespace ps
