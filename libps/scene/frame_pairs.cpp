// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/frame_pairs.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "libps/core/parallel.h"
#include "libps/eval/statistics.h"
#include "libps/scene/lone_pixels.h"

namespace ps {
namespace {

constexpr float kDarkest = .04f, kBrightest = .97f;  ///< beyond, sensors clip
constexpr double kExact = .02;  ///< spread of a pair's log ratios that is as good as none

MiddleRatio middle_of(std::vector<double> ratios) {
  if (ratios.size() < kLeastOverlap) return {};
  const double middle = median(ratios);
  for (double& ratio : ratios) ratio = std::abs(ratio - middle);
  return {middle, 1 / std::pow(median(std::move(ratios)) + kExact, 2)};
}

/// Log ratios of the pixels of one frame and another.
struct Ratios {
  std::vector<double> color[3], depth;
};

void compare(const SmallFrame& from, const SmallFrame& to, double scale_from, double scale_to,
             double tolerance, bool swapped, FramePair* pair, Ratios* ratios) {
  const Pose to_from_from = to.view.world_from_cam.inverse() * from.view.world_from_cam;
  const Depth& depth = from.view.depth;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      if (!(depth(y, x) > 0)) continue;
      const Eigen::Vector3d p =
          to_from_from * from.view.intrinsics.lift(x, y, depth(y, x) * scale_from);
      if (!(p.z() > 0)) continue;
      const Eigen::Vector2d at = to.view.intrinsics.project(p);
      if (!(at.x() > 0 && at.y() > 0 && at.x() < to.view.depth.cols - 1 &&
            at.y() < to.view.depth.rows - 1)) {
        continue;
      }
      const int u = static_cast<int>(std::lround(at.x())),
                v = static_cast<int>(std::lround(at.y()));
      const double there = to.view.depth(v, u) * scale_to;
      if (!(there > 0) || p.z() > to.farthest(v, u) * scale_to * (1 + tolerance)) continue;
      if (p.z() < to.nearest(v, u) * scale_to * (1 - tolerance)) {
        ++pair->before;
        continue;
      }
      ++pair->agree;
      const double sign = swapped ? -1 : 1;
      ratios->depth.push_back(sign * std::log(p.z() / there));
      const cv::Vec3f ours = from.view.color(y, x), theirs = to.view.color(v, u);
      for (int c = 0; c < 3; ++c) {
        const bool told =
            std::min(ours[c], theirs[c]) > kDarkest && std::max(ours[c], theirs[c]) < kBrightest;
        if (told) ratios->color[c].push_back(sign * std::log(ours[c] / theirs[c]));
      }
    }
  }
}

void summarise(Ratios ratios, FramePair* pair) {
  for (int c = 0; c < 3; ++c) pair->color[c] = middle_of(std::move(ratios.color[c]));
  pair->depth = middle_of(ratios.depth);
  if (!pair->overlaps()) return;
  for (double& ratio : ratios.depth) ratio = std::abs(ratio);
  pair->apart = median(std::move(ratios.depth));
}

}  // namespace

SmallFrame reduced_frame(const View& view, int width, const std::string& where) {
  SmallFrame small;
  if (view.depth.empty()) return small;
  check(view, where);
  const double scale = std::min(1.0, static_cast<double>(width) / view.depth.cols);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(view.depth.cols * scale))),
                      std::max(1, static_cast<int>(std::lround(view.depth.rows * scale))));
  small.view.world_from_cam = view.world_from_cam;
  small.view.intrinsics = resized(view.intrinsics, size.width, size.height);
  cv::resize(view.color, small.view.color, size, 0, 0, cv::INTER_AREA);
  cv::resize(view.depth, small.view.depth, size, 0, 0, cv::INTER_NEAREST_EXACT);
  cv::patchNaNs(small.view.depth, 0);
  small.view.depth.setTo(0, small.view.depth < 0);
  small.view.depth.setTo(0, lone_pixels(small.view.depth, kAgreeing));
  const cv::Mat1b window(3, 3, 1);
  Depth known = small.view.depth.clone();
  cv::dilate(known, small.farthest, window);
  known.setTo(1e9f, known == 0);
  cv::erode(known, small.nearest, window);
  return small;
}

std::vector<FramePair> plan_pairs(const std::vector<SmallFrame>& frames, int partners) {
  const std::size_t n = frames.size();
  std::vector<std::size_t> steps;
  const auto half = static_cast<std::size_t>(std::max(1, partners / 2));
  for (std::size_t i = 1; i <= half && i < n; ++i) {
    steps.push_back(i <= half / 2 ? i : half / 2 + (i - half / 2) * (n - half / 2) / (half + 1));
  }
  std::vector<FramePair> pairs;
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t last = 0;
    for (const std::size_t step : steps) {
      if (step <= last || i + step >= n) continue;
      last = step;
      if (!frames[i].usable() || !frames[i + step].usable()) continue;
      pairs.emplace_back();
      pairs.back().a = i;
      pairs.back().b = i + step;
    }
  }
  return pairs;
}

void hold_against_each_other(const std::vector<SmallFrame>& frames,
                             const std::vector<FrameWord>& words, double tolerance,
                             std::vector<FramePair>* pairs) {
  parallel_for(pairs->size(), [&](std::size_t i) {
    FramePair fresh;
    fresh.a = (*pairs)[i].a;
    fresh.b = (*pairs)[i].b;
    const SmallFrame &a = frames[fresh.a], &b = frames[fresh.b];
    const double scale_a = words[fresh.a].scale, scale_b = words[fresh.b].scale;
    Ratios ratios;
    compare(a, b, scale_a, scale_b, tolerance, false, &fresh, &ratios);
    compare(b, a, scale_b, scale_a, tolerance, true, &fresh, &ratios);
    summarise(std::move(ratios), &fresh);
    (*pairs)[i] = fresh;
  });
}

}  // namespace ps
