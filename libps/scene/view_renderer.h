// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "libps/core/image.h"
#include "libps/geometry/camera.h"
#include "libps/geometry/splat.h"
#include "libps/models/refiner.h"
#include "libps/scene/closed_splat.h"

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace ps {

struct Point;

struct ViewRendererOptions {
  /// What the refiner is given, its background then set to grey; its radius is also that of the
  /// widest splats that show the cloud.
  SplatOptions splat;
  float finest = kFinestSplat;  ///< pixels of the view; of the splats that show the cloud
  bool as_published = false;    ///< the refiner's picture alone
  std::uint64_t seed = 0;       ///< of the refiner's noise, which is the same for all views
};

struct RenderedView {
  Image color;               ///< [0,1], of the lens's size
  Splat splat;               ///< of the cloud into this lens (closed_splat.h)
  double missing_share = 0;  ///< of its pixels: what the refiner alone had to fill in
};

/// @brief What of a view the cloud itself shows: `splat`, and `color`, which is its own. Throws
/// ps::Error when lens or pose are unsound.
RenderedView cloud_picture(const pcl::PointCloud<Point>& cloud, const Intrinsics& lens,
                           const Pose& world_from_cam, const ViewRendererOptions& options = {});

/// @brief Any view of a scene's cloud: splat and refinement (SPEC.md 1).
///
/// Where the cloud is seen, it is shown as it is, at the view's full size: a wide splat shows
/// slanted surfaces some pixels beside their place, as the nearest of its points wins, and a
/// network repaints what is known. What is missing is the refiner's, which sees 256 pixels along
/// the short side, moved towards the colours at the seam, without colours stronger than the cloud's
/// (muted_colors.h). Not for two threads at once.
class ViewRenderer {
 public:
  /// @param refiner  must outlive this; null = no network: what the cloud shows, and the background
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
