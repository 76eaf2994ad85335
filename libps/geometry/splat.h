// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "libps/core/image.h"
#include "libps/geometry/camera.h"

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace ps {

/// @brief What the soft z-buffer does with each point (SPEC.md 4; PixelSynth section 3.1, after
/// Wiles et al., SynSin, CVPR 2020).
struct SplatOptions {
  float radius = 4;  ///< pixels, at any image size; a hit is closer than this
  /// Pixels; above 0, each point has its own radius: what its footprint covers where it is drawn,
  /// at least this and at most `radius`. So the camera that saw points sees them as they were.
  float finest = 0;
  /// Share of the depth of a pixel's first hit; what is farther behind it is hidden, and no hit.
  /// Else narrow splats, which are thin where they end, let what is behind a surface shine through.
  /// If finite, hits are within nine tenths of the radius.
  float thickness = std::numeric_limits<float>::infinity();
  int points_per_pixel = 128;  ///< only the nearest so many hits of a pixel count
  int dilation = 13;           ///< side of the square that widens the missing mask; odd; 1 = none
  float near = 1e-3f;          ///< metres; points at or before this depth are skipped
  cv::Vec3f background = {0, 0, 0};  ///< colour of the transmittance that is left behind all hits
  bool renormalise = false;  ///< instead, divide the colour by what was absorbed where any was
  bool count_hits = false;   ///< fill Splat::count and Splat::nearest; costs the early stop
};

/// @brief A picture of a cloud. All images are of the camera's size.
struct Splat {
  Image color;           ///< sum of alpha T c over the hits, front to back, and the background
  Depth first_depth;     ///< metres; depth of the nearest hit; 0 = no hit
  Depth expected_depth;  ///< metres; sum of alpha T z over sum of alpha T; 0 = no hit
  Mask hit;              ///< 1 where at least one point hits
  Mask missing;          ///< 1 where none hits, widened by the dilation
  cv::Mat1i count;       ///< hits a pixel counts, at most points_per_pixel; only if asked for
  cv::Mat_<cv::Vec4i> nearest;  ///< indices of the four nearest hits, -1 = none; only if asked for
};

/// @brief Points of any layout, world frame, metres; borrowed, not owned.
/// Each point's record starts with float x, y, z; `rgb` is the byte offset of its b, g, r bytes
/// (PCL's order) from the record's start, `footprint` that of a float, metres; 0 = it has none.
struct PointsView {
  const std::byte* data = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;
  std::size_t rgb = 0;
  std::size_t footprint = 0;
};

template <typename PointT, typename = void>
struct HasFootprint : std::false_type {};
template <typename PointT>
struct HasFootprint<PointT, std::void_t<decltype(std::declval<PointT>().footprint)>>
    : std::true_type {};

/// @return a view of any PCL cloud whose points have x, y, z and rgb, and perhaps a footprint
template <typename PointT>
PointsView points_view(const pcl::PointCloud<PointT>& cloud) {
  if (cloud.empty()) return {};
  const auto* x = reinterpret_cast<const std::byte*>(&cloud.points.front().x);
  const auto offset = [&](const float& field) {
    return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&field) - x);
  };
  PointsView view = {x, cloud.points.size(), sizeof(PointT), offset(cloud.points.front().rgb), 0};
  if constexpr (HasFootprint<PointT>::value) {
    view.footprint = offset(cloud.points.front().footprint);
  }
  return view;
}

/// @brief Points in the image plane, ready to be splatted; arrays of one length.
struct PlanePoints {
  std::vector<float> u;  ///< pixels
  std::vector<float> v;  ///< pixels
  std::vector<float> z;  ///< depth, any unit; skipped unless > SplatOptions::near and finite
  std::vector<cv::Vec3f> color;  ///< any range
};

/// @brief Splats a cloud into a camera. Points that are not finite are skipped.
/// The result does not depend on the number of threads or on the machine's vector width.
/// Throws ps::Error when the camera, the pose or an option is unsound: sides up to 16384 pixels,
/// radius in (0, 64], finest and thickness at least 0, dilation odd, near at least 0.
Splat splat(const PointsView& points, const Intrinsics& intrinsics, const Pose& world_from_cam,
            const SplatOptions& options = {});

template <typename PointT>
Splat splat(const pcl::PointCloud<PointT>& cloud, const Intrinsics& intrinsics,
            const Pose& world_from_cam, const SplatOptions& options = {}) {
  return splat(points_view(cloud), intrinsics, world_from_cam, options);
}

/// @brief Splats points that are already in the image plane, all of options.radius. Hits are
/// ordered by (depth, index).
Splat splat_plane(const PlanePoints& points, cv::Size size, const SplatOptions& options = {});

}  // namespace ps
