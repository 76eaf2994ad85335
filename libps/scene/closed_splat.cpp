// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/closed_splat.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "libps/core/error.h"

namespace ps {
namespace {

constexpr float kNearer = 1.05f;  ///< in inverse depth; of what is another surface
/// Pixels; through wider gaps of a surface what is behind is taken to be seen: a closing so wide
/// would fill the corners of rooms.
constexpr float kSeenThrough = 4;

/// Inverse depth with what is seen through holes of one or two pixels closed, but no slits: closed
/// along lines of each of four directions, the least of these.
cv::Mat1f closed_pinholes(const cv::Mat1f& inverse) {
  const cv::Mat1b across = cv::Mat1b::ones(1, 3), down = cv::Mat1b::ones(3, 1),
                  falling = cv::Mat1b::eye(3, 3);
  cv::Mat1b rising;
  cv::flip(falling, rising, 1);
  cv::Mat1f least, closed;
  for (const cv::Mat1b& line : {across, down, falling, rising}) {
    cv::morphologyEx(inverse, closed, cv::MORPH_CLOSE, line);
    least = least.empty() ? closed.clone() : cv::Mat1f(cv::min(least, closed));
  }
  return least;
}

/// Inverse depth of the surfaces around gaps that are at most so wide, in these gaps; else 0.
cv::Mat1f closed_depth(const cv::Mat1f& inverse, const Mask& hit, float radius) {
  const int side = 2 * static_cast<int>(std::ceil(radius)) + 1;
  const cv::Mat square = cv::Mat::ones(side, side, CV_8U);
  cv::Mat1f closed;
  cv::morphologyEx(inverse, closed, cv::MORPH_CLOSE, square);
  if (radius > kSeenThrough) {
    closed.setTo(0, hit);
    return closed;
  }
  // A closed surface has no gaps, but what is seen between two of them: only points that stand
  // apart, which an opening removes, hide what is behind them.
  cv::Mat1f opened, apart = inverse.clone(), closed_apart;
  cv::morphologyEx(inverse, opened, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  apart.setTo(0, inverse <= kNearer * opened);
  cv::morphologyEx(apart, closed_apart, cv::MORPH_CLOSE, square);
  closed_apart = cv::max(closed_apart, closed_pinholes(inverse));
  closed_apart.copyTo(closed, hit);
  closed.setTo(0, closed <= kNearer * inverse);
  return closed;
}

/// Grows what is shown into gaps, ring by ring.
class GapFiller {
 public:
  /// @param inverse  of what is shown; gets that of what is filled in
  GapFiller(Splat* shown, cv::Mat1f* inverse) : shown_(*shown), inverse_(*inverse) {}

  /// @param closed  of closed_depth()
  void fill(const cv::Mat1f& closed) {
    std::vector<cv::Point> gaps;
    cv::findNonZero(closed > 0, gaps);
    bool any = false;  // else only of the surface itself
    while (!gaps.empty()) {
      std::vector<Pixel> ring;
      std::vector<cv::Point> left;
      for (const cv::Point& gap : gaps) {
        const Pixel pixel = mean_around(gap, closed(gap), any);
        if (pixel.weight > 0) {
          ring.push_back(pixel);
        } else {
          left.push_back(gap);
        }
      }
      if (ring.empty() && any) return;
      any = ring.empty();
      for (const Pixel& pixel : ring) take(pixel);
      gaps.swap(left);
    }
  }

 private:
  struct Pixel {
    cv::Point at;
    float weight = 0;
    cv::Vec3f color;  ///< this and the others: sums
    float inverse = 0;
    float depth = 0;

    void add(float share, const cv::Vec3f& other_color, float other_inverse, float other_depth) {
      weight += share;
      color += share * other_color;
      inverse += share * other_inverse;
      depth += share * other_depth;
    }
  };

  /// Of the pixels around it that show the surface.
  /// @param any  whatever they show, if nothing is shown there
  Pixel mean_around(const cv::Point& at, float surface, bool any) const {
    const float least = any && !shown_.hit(at) ? 0 : surface / kNearer;
    Pixel pixel;
    pixel.at = at;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const cv::Point other(at.x + dx, at.y + dy);
        if (!cv::Rect({}, inverse_.size()).contains(other) || !shown_.hit(other)) continue;
        if (inverse_(other) < least) continue;
        const float share = dx != 0 && dy != 0 ? .5f : 1.f;
        pixel.add(share, shown_.color(other), inverse_(other), shown_.expected_depth(other));
      }
    }
    return pixel;
  }

  void take(const Pixel& pixel) {
    inverse_(pixel.at) = pixel.inverse / pixel.weight;
    shown_.color(pixel.at) = pixel.color / pixel.weight;
    shown_.expected_depth(pixel.at) = pixel.depth / pixel.weight;
    shown_.first_depth(pixel.at) = pixel.weight / pixel.inverse;
    shown_.hit(pixel.at) = 1;
  }

  Splat& shown_;
  cv::Mat1f& inverse_;
};

}  // namespace

Splat closed_splat(const PointsView& points, const Intrinsics& intrinsics,
                   const Pose& world_from_cam, const SplatOptions& options, float finest) {
  if (!(finest > 0)) throw Error("finest splat", std::to_string(finest), "above 0 pixels");
  SplatOptions level = options;
  level.finest = std::min(options.radius, finest);
  if (level.finest < options.radius) level.thickness = kNearer - 1;
  Splat shown = splat(points, intrinsics, world_from_cam, level);
  if (level.finest == options.radius) return shown;
  cv::Mat1f inverse = 1 / shown.first_depth;
  inverse.setTo(0, shown.hit == 0);
  GapFiller filler(&shown, &inverse);
  for (float radius = level.finest; radius < options.radius;) {
    // Whatever the finest is, kSeenThrough is one of the levels.
    const float next = radius < kSeenThrough ? std::min(2 * radius, kSeenThrough) : 2 * radius;
    radius = std::min(next, options.radius);
    filler.fill(closed_depth(inverse, shown.hit, radius));
  }
  cv::dilate(shown.hit == 0, shown.missing, cv::Mat1b(options.dilation, options.dilation, 1));
  shown.missing &= 1;
  return shown;
}

}  // namespace ps
