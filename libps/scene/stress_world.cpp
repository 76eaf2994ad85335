// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/stress_world.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "libps/core/random.h"
#include "libps/eval/pairs.h"
#include "libps/geometry/lift.h"
#include "libps/rooms/camera.h"
#include "libps/rooms/shot.h"
#include "libps/scene/room_view.h"

namespace ps::stress {
namespace {

constexpr float kTurned = .8f, kMoved = .7f;  ///< radians and metres, of a walk
constexpr double kMetresPerDegree = .02;
constexpr double kElsewhereTurned = 20, kElsewhereMoved = .2;  ///< degrees and metres, of a photo
constexpr double kGamma = 2.2;
enum Purpose : std::uint32_t { kPixel, kFrame, kBlots, kCamera };

std::uint64_t key(std::uint64_t seed, std::uint32_t i) {
  const auto bits = random_bits(seed, {i, kCamera, 0x737472u, 0});
  return static_cast<std::uint64_t>(bits[0]) << 32 | bits[1];
}

rooms::Camera first_camera(const rooms::Room& room, std::uint64_t seed, cv::Size size) {
  rooms::CameraOptions options;
  options.width = size.width;
  options.height = size.height;
  options.min_fov = 60;
  options.max_fov = 75;
  return rooms::random_camera(room, seed, options);
}

/// What is assigned to an image otherwise lands in the view's own pixels.
View copy_of(const View& view) {
  View copy = view;
  copy.color = view.color.clone();
  copy.depth = view.depth.clone();
  return copy;
}

View scaled(const View& view, double factor) {
  View result = copy_of(view);
  result.depth *= factor;
  return result;
}

}  // namespace

World make_world(std::uint64_t seed, int frames, int held_out, cv::Size size) {
  const rooms::Room room(seed);
  const rooms::Camera first = first_camera(room, key(seed, 0), size);
  World world;
  for (int i = 0; i < frames + held_out; ++i) {
    const rooms::Camera camera =
        i == 0 ? first : rooms::moved(room, first, key(seed, i), kTurned, kMoved);
    (i < frames ? world.frames : world.held_out).push_back(shoot_view(room, camera));
  }
  return completed(std::move(world));
}

World completed(World world) {
  LiftOptions all;
  all.edge_footprints = 0;
  for (const View& view : world.frames) world.truth += lift(view, 0, Origin::observed, all);
  for (const View& view : world.held_out) {
    Mask covered = Mask::zeros(view.depth.size());
    for (const View& frame : world.frames) covered |= true_visibility(frame, view).visible;
    world.covered.push_back(covered);
  }
  return world;
}

Photo make_photo(std::uint64_t seed, cv::Size size, const rooms::RoomOptions& options) {
  const rooms::Room room(seed, options);
  View view = shoot_view(room, first_camera(room, key(seed, 0), size));
  // Outside of windows is far away.
  view.depth.setTo(20, view.depth == 0);
  Photo photo;
  photo.view = photo.known = view;
  photo.lens = view.intrinsics;
  photo.world_from_cam = moved_pose(view.world_from_cam, kElsewhereTurned, {kElsewhereMoved, 0, 0});
  photo.shoot = [room](const Intrinsics& lens, const Pose& pose) {
    return shoot_view(room, room_camera(lens, pose));
  };
  return photo;
}

Pose moved_pose(const Pose& pose, double degrees, const Eigen::Vector3d& metres) {
  return pose * Eigen::AngleAxisd(degrees * CV_PI / 180, Eigen::Vector3d::UnitY()) *
         Eigen::Translation3d(metres);
}

double normal_at(const Draw& draw, int x, int y) {
  return random_normal(draw.seed, {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                   draw.frame, kPixel})[0];
}

double even_at(const Draw& draw, std::uint32_t k) {
  return random_unit(draw.seed, {k, 0, draw.frame, kFrame});
}

View with_noise(const View& view, double share, const Draw& draw) {
  View result = copy_of(view);
  for (int y = 0; y < result.depth.rows; ++y) {
    for (int x = 0; x < result.depth.cols; ++x) {
      float& d = result.depth(y, x);
      d = static_cast<float>(std::max(0.0, d * (1 + share * normal_at(draw, x, y))));
    }
  }
  return result;
}

View with_bias(const View& view, double share) { return scaled(view, 1 + share); }

View with_scale(const View& view, double share, const Draw& draw) {
  return scaled(view, std::exp(share * normal_at(draw, -1, -1)));
}

Mask blots(cv::Size size, double share, const Draw& draw) {
  if (share <= 0) return Mask::zeros(size);
  if (share >= 1) return Mask::ones(size);
  cv::Mat1f noise(size.height / 8 + 2, size.width / 8 + 2), smooth;
  for (int y = 0; y < noise.rows; ++y) {
    for (int x = 0; x < noise.cols; ++x) {
      noise(y, x) = static_cast<float>(random_unit(
          draw.seed,
          {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), draw.frame, kBlots}));
    }
  }
  cv::resize(noise, smooth, size, 0, 0, cv::INTER_CUBIC);
  std::vector<float> sorted(smooth.begin(), smooth.end());
  const auto at =
      sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  return (smooth <= *at) / 255;
}

View with_holes(const View& view, double share, const Draw& draw) {
  View result = copy_of(view);
  result.depth.setTo(0, blots(view.depth.size(), share, draw));
  return result;
}

View with_soft_edges(const View& view, double pixels) {
  View result = copy_of(view);
  const int side = 2 * static_cast<int>(std::lround(pixels / 2)) + 1;
  if (side > 1) cv::blur(view.depth, result.depth, {side, side}, {-1, -1}, cv::BORDER_REPLICATE);
  result.depth.setTo(0, view.depth == 0);
  return result;
}

View with_pose_noise(const View& view, double degrees, const Draw& draw) {
  const auto any = [&](int i) {
    return Eigen::Vector3d(normal_at(draw, i, -1), normal_at(draw, i, -2), normal_at(draw, i, -3));
  };
  View result = view;
  result.world_from_cam = view.world_from_cam *
                          Eigen::Translation3d(any(0).normalized() * kMetresPerDegree * degrees) *
                          Eigen::AngleAxisd(degrees * CV_PI / 180, any(1).normalized());
  return result;
}

View with_exposure(const View& view, double stops) {
  View result = copy_of(view);
  result.color *= std::exp2(stops / kGamma);
  for (cv::Vec3f& c : result.color) {
    for (int k = 0; k < 3; ++k) c[k] = std::min(c[k], 1.f);
  }
  return result;
}

View with_focal(const View& view, double share) {
  View result = view;
  result.intrinsics.fx *= 1 + share;
  result.intrinsics.fy *= 1 + share;
  return result;
}

View with_principal_point(const View& view, double share) {
  View result = view;
  result.intrinsics.cx += share * view.intrinsics.width;
  return result;
}

View shrunk(const View& view, double times) {
  const auto side = [&](int pixels) { return std::max(2, static_cast<int>(pixels / times)); };
  View result;
  result.world_from_cam = view.world_from_cam;
  result.intrinsics = resized(view.intrinsics, side(view.color.cols), side(view.color.rows));
  const cv::Size size(result.intrinsics.width, result.intrinsics.height);
  cv::resize(view.color, result.color, size, 0, 0, cv::INTER_AREA);
  cv::resize(view.depth, result.depth, size, 0, 0, cv::INTER_NEAREST_EXACT);
  return result;
}

View with_glass(const View& view, double share, const Draw& draw) {
  View result = copy_of(view);
  const Mask pane = blots(view.depth.size(), share, draw);
  for (int y = 0; y < pane.rows; ++y) {
    for (int x = 0; x < pane.cols; ++x) {
      if (!pane(y, x)) continue;
      const double what = std::erf(normal_at(draw, x, y) / std::sqrt(2.0));  // even in (-1, 1)
      float& d = result.depth(y, x);
      if (what < -1.0 / 3) d = 0;
      if (what > 1.0 / 3) d *= static_cast<float>(1 + 3 * (what - 1.0 / 3));
    }
  }
  return result;
}

}  // namespace ps::stress
