// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/relative_pose.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "libps/core/error.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/overlap.h"
#include "libps/geometry/photo_matches.h"
#include "libps/geometry/pose_fit.h"

namespace ps {
namespace {

constexpr double kFeatureSigma = 0.7;      ///< pixels of the picture that features are found in
constexpr double kDepthError = 0.15;       ///< relative; fits begin with it
constexpr double kPointTolerance = 12;     ///< pixel sigmas that P3P forgives wrong depths
constexpr double kDirectionTolerance = 3;  ///< pixel sigmas from an epipolar line
constexpr double kSameSurface = 0.4;  ///< log ratio; farther off, one view sees another surface
/// Standard deviations above which a pose is not determined.
constexpr double kMostTurn = 0.05;   ///< radians
constexpr double kMostShift = 0.15;  ///< of the median depth
constexpr double kFarthest = 8;      ///< baseline, in median depths

[[noreturn]] void refuse(const std::string& what, const std::string& expected) {
  throw Error("second photo", what, expected + ", or its pose (--second-pose FILE)");
}

void check(const View& first, const Image& second, const Intrinsics& lens, const Depth& depth) {
  check(first, "first photo");
  check(lens, "second photo");
  if (second.size() != cv::Size(lens.width, lens.height)) {
    throw Error("second photo", "photo and intrinsics differ in size", "one size");
  }
  if (!depth.empty() && depth.size() != second.size()) {
    throw Error("second photo", "photo and depth differ in size", "one size");
  }
}

/// The upper one of an even number; 0 of none.
double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Matches as sightings, and where they are in both photos.
struct Sightings {
  std::vector<Sighting> list;
  std::vector<PixelMatch> pixels;
};

Sightings sightings_of(const View& first, const Image& second) {
  const Mask usable = liftable(first.depth, first.intrinsics);
  Sightings sightings;
  std::vector<double> depths;
  for (const PixelMatch& match : match_photos(first.color, second)) {
    const double d = surface_depth(first.depth, usable, match.first.x(), match.first.y());
    if (d > 0) depths.push_back(d);
    sightings.list.push_back(
        {first.intrinsics.lift(match.first.x(), match.first.y(), d > 0 ? d : 1), match.second,
         d > 0});
    sightings.pixels.push_back(match);
  }
  if (depths.empty() && !sightings.list.empty()) {
    refuse("shares no place with the first at which that has a depth", "more in common");
  }
  const double middle = median(depths);
  for (Sighting& s : sightings.list) {
    if (!s.depth_known) s.point_in_first *= middle;
  }
  return sightings;
}

PoseFit best_fit(const std::vector<Sighting>& sightings, const Intrinsics& lens,
                 double pixel_sigma) {
  PoseFit best;
  best.inlier.resize(sightings.size());
  const auto fit_from = [&](const Pose& start) {
    PoseFit fit = fit_pose(sightings, lens, start, pixel_sigma, kDepthError);
    if (fit.log_likelihood > best.log_likelihood) best = std::move(fit);
  };
  Pose start;
  if (start_from_points(sightings, lens, kPointTolerance * pixel_sigma, &start)) fit_from(start);
  if (start_from_directions(sightings, lens, kDirectionTolerance * pixel_sigma, &start)) {
    fit_from(start);
  }
  return best;
}

/// @return the share of a photo that pixels are spread over: that of an even ellipse of their
/// covariance, which a few strays hardly widen
double cover(const std::vector<Eigen::Vector2d>& pixels, double area) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : pixels) mean += p / static_cast<double>(pixels.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const auto& p : pixels) {
    covariance += (p - mean) * (p - mean).transpose() / static_cast<double>(pixels.size());
  }
  return 4 * M_PI * std::sqrt(std::max(covariance.determinant(), 0.0)) / area;
}

void check_cover(const Sightings& sightings, const PoseFit& fit, cv::Size first, cv::Size second,
                 double least) {
  std::vector<Eigen::Vector2d> in_first, in_second;
  for (std::size_t i = 0; i < sightings.pixels.size(); ++i) {
    if (!fit.inlier[i]) continue;
    in_first.push_back(sightings.pixels[i].first);
    in_second.push_back(sightings.pixels[i].second);
  }
  const double share = std::min(cover(in_first, first.area()), cover(in_second, second.area()));
  if (share >= least) return;
  refuse("what it shares with the first lies in " + std::to_string(100 * share) + " % of a photo",
         "at least " + std::to_string(100 * least) + " %");
}

void check_pose(const std::vector<Sighting>& sightings, const PoseFit& fit) {
  std::vector<double> depths;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (fit.inlier[i] && sightings[i].depth_known)
      depths.push_back(sightings[i].point_in_first.z());
  }
  const double depth = median(depths);
  const double baseline = fit.second_from_first.translation().norm();
  if (!(fit.rotation_sigma < kMostTurn && fit.translation_sigma < kMostShift * depth)) {
    refuse("what it shares with the first does not determine its pose", "more in common");
  }
  if (!(baseline < kFarthest * depth)) {
    refuse("would stand " + std::to_string(baseline) + " m from the first, which shows things at " +
               std::to_string(depth) + " m",
           "a photo taken nearer to the first");
  }
}

double median_error(const std::vector<Sighting>& sightings, const PoseFit& fit,
                    const Intrinsics& lens) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!fit.inlier[i] || !sightings[i].depth_known) continue;
    const Eigen::Vector3d p = fit.second_from_first * sightings[i].point_in_first;
    errors.push_back((lens.project(p) - sightings[i].pixel_in_second).norm());
  }
  return median(errors);
}

/// Log ratios at the inliers: the first's depth, seen from the second, over the second's.
std::vector<double> ratios_at_inliers(const std::vector<Sighting>& sightings, const PoseFit& fit,
                                      const View& second) {
  const Mask usable = liftable(second.depth, second.intrinsics);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!fit.inlier[i] || !sightings[i].depth_known) continue;
    const Eigen::Vector2d& at = sightings[i].pixel_in_second;
    const double d = surface_depth(second.depth, usable, at.x(), at.y());
    const double z = (fit.second_from_first * sightings[i].point_in_first).z();
    if (d > 0) ratios.push_back(std::log(z / d));
  }
  return ratios;
}

constexpr std::size_t kFew = 5;

/// The log ratios of what both see that are near to the median of those given; others are of two
/// surfaces. Those given, where there are few.
std::vector<double> settled(const std::vector<DepthRatio>& all, std::vector<double> ratios) {
  for (int round = 0; round < 3; ++round) {
    const double middle = median(ratios);
    std::vector<double> near;
    for (const DepthRatio& r : all) {
      if (std::abs(r.log_ratio - middle) < kSameSurface) near.push_back(r.log_ratio);
    }
    if (near.size() < kFew) break;
    ratios = near;
  }
  return ratios;
}

void compare_depths(const View& first, const View& second, std::vector<double> ratios,
                    SecondPose* result) {
  const std::vector<DepthRatio> all = depth_ratios(first, second);
  if (ratios.size() < kFew) {
    for (const DepthRatio& r : all) ratios.push_back(r.log_ratio);
  }
  if (ratios.size() < kFew) {
    refuse("its depth is unknown where both photos see", "a depth there, or none at all");
  }
  ratios = settled(all, std::move(ratios));
  const double middle = median(ratios);
  for (double& r : ratios) r = std::abs(r - middle);
  result->depth_scale = std::exp(middle);
  result->depth_spread = median(ratios);
}

}  // namespace

SecondPose find_second_pose(const View& first, const Image& second, const Intrinsics& second_lens,
                            const Depth& second_depth, const SecondPoseOptions& options) {
  check(first, second, second_lens, second_depth);
  const Sightings sightings = sightings_of(first, second);
  // A feature is found to about a pixel of the picture it is found in, in the coarser photo.
  const double pixel_sigma =
      std::max(pixels_per_feature_pixel(second.size()),
               pixels_per_feature_pixel(first.color.size()) *
                   first.intrinsics.footprint_per_metre() / second_lens.footprint_per_metre());
  const PoseFit fit = best_fit(sightings.list, second_lens, kFeatureSigma * pixel_sigma);
  if (fit.inliers < std::max<std::size_t>(options.least_inliers, 1)) {
    refuse(std::to_string(fit.inliers) + " of its " + std::to_string(sightings.list.size()) +
               " matches with the first fit one pose",
           "at least " + std::to_string(options.least_inliers) +
               ": photos of one place that have much in common");
  }
  check_cover(sightings, fit, first.color.size(), second.size(), options.least_cover);
  check_pose(sightings.list, fit);
  SecondPose result;
  result.world_from_cam = first.world_from_cam * fit.second_from_first.inverse();
  result.matches = sightings.list.size();
  result.inliers = fit.inliers;
  result.reprojection_error = median_error(sightings.list, fit, second_lens);
  result.depth_error = fit.depth_error;
  result.depth_spread = std::numeric_limits<double>::quiet_NaN();
  if (!second_depth.empty()) {
    const View view{second, second_depth, second_lens, result.world_from_cam};
    compare_depths(first, view, ratios_at_inliers(sightings.list, fit, view), &result);
  }
  return result;
}

double depth_scale_between(const View& first, const View& second) {
  check(first, "first photo");
  check(second, "second photo");
  const std::vector<DepthRatio> all = depth_ratios(first, second);
  std::vector<double> ratios;
  for (const DepthRatio& r : all) ratios.push_back(r.log_ratio);
  return ratios.empty() ? 1 : std::exp(median(settled(all, std::move(ratios))));
}

}  // namespace ps
