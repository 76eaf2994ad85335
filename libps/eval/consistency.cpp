// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/consistency.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/image_metrics.h"

namespace ps {
namespace {

constexpr char kWhere[] = "consistency";
/// 0.05 pixels at half a metre through a lens of 256 pixels: far below what resampling does.
constexpr double kSameCentre = 1e-4;
/// Pixels; so that a camera that is not turned sees all of its own image, rounding or no.
constexpr double kRounding = 1e-6;

void check_sizes(const View& source, const Intrinsics& target) {
  check(source.intrinsics, kWhere);
  check(target, kWhere);
  const cv::Size lens(source.intrinsics.width, source.intrinsics.height);
  if (source.color.size() == lens) return;
  throw Error(kWhere,
              "an image has " + std::to_string(source.color.cols) + "x" +
                  std::to_string(source.color.rows) + " pixels",
              std::to_string(lens.width) + "x" + std::to_string(lens.height) + ", as its lens");
}

/// @return whether (u, v) lies between pixels of the image
bool bilinear(const Image& image, double u, double v, cv::Vec3f& color) {
  const double right = image.cols - 1, bottom = image.rows - 1;
  if (!(u >= -kRounding && v >= -kRounding && u <= right + kRounding && v <= bottom + kRounding)) {
    return false;
  }
  u = std::clamp(u, 0.0, right);
  v = std::clamp(v, 0.0, bottom);
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const int x1 = std::min(x + 1, image.cols - 1), y1 = std::min(y + 1, image.rows - 1);
  const auto across = static_cast<float>(u - x), along = static_cast<float>(v - y);
  const cv::Vec3f above = image(y, x) * (1 - across) + image(y, x1) * across;
  const cv::Vec3f below = image(y1, x) * (1 - across) + image(y1, x1) * across;
  color = above * (1 - along) + below * along;
  return true;
}

struct OneWay {
  double psnr, perceptual, overlap;
};

/// The target's image against what its camera would show of the source's.
OneWay one_way(const View& source, const View& target, const PerceptualDistance& perceptual) {
  const Warp warp = warp_rotation(source, target.intrinsics, target.world_from_cam);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const int pixels = cv::countNonZero(warp.valid);
  if (pixels == 0) return {kNan, kNan, 0};
  Image masked(target.color.size(), cv::Vec3f(0, 0, 0));
  target.color.copyTo(masked, warp.valid);
  return {psnr(warp.color, target.color, warp.valid),
          perceptual ? perceptual(warp.color, masked) : kNan,
          pixels / static_cast<double>(warp.valid.total())};
}

/// Of those that are numbers: an overlap of a pixel's width may be one from one side alone.
double mean(double a, double b) {
  if (std::isnan(a)) return b;
  return std::isnan(b) ? a : (a + b) / 2;
}

}  // namespace

Warp warp_rotation(const View& source, const Intrinsics& target, const Pose& world_from_target) {
  check_sizes(source, target);
  const Pose from = checked_pose(source.world_from_cam.matrix(), kWhere);
  const Pose to = checked_pose(world_from_target.matrix(), kWhere);
  const double apart = (from.translation() - to.translation()).norm();
  if (apart > kSameCentre) {
    throw Error(kWhere, "the cameras are " + std::to_string(apart) + " m apart",
                "one centre: views that are only turned");
  }
  const Eigen::Matrix3d source_from_target = from.linear().transpose() * to.linear();
  Warp warp;
  warp.color = Image(target.height, target.width, cv::Vec3f(0, 0, 0));
  warp.valid = Mask::zeros(target.height, target.width);
  parallel_for(static_cast<std::size_t>(target.height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < target.width; ++x) {
      const Eigen::Vector3d ray = source_from_target * target.lift(x, y, 1);
      if (ray.z() <= 0) continue;
      const Eigen::Vector2d at = source.intrinsics.project(ray);
      if (bilinear(source.color, at.x(), at.y(), warp.color(y, x))) warp.valid(y, x) = 1;
    }
  });
  return warp;
}

ConsistencyScore consistency(const View& a, const View& b, const PerceptualDistance& perceptual) {
  check_sizes(a, b.intrinsics);
  check_sizes(b, a.intrinsics);
  const OneWay there = one_way(a, b, perceptual), back = one_way(b, a, perceptual);
  return {mean(there.psnr, back.psnr), mean(there.perceptual, back.perceptual),
          (there.overlap + back.overlap) / 2};
}

}  // namespace ps
