// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/scene_builder.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "libps/core/clock.h"
#include "libps/core/error.h"
#include "libps/geometry/point.h"
#include "libps/scene/muted_colors.h"
#include "libps/scene/network_view.h"

namespace ps {
namespace {

/// A pixel is covered when a point is nearer than this to its centre: pixels that only a wide splat
/// reaches are still to be filled.
constexpr float kCoverRadius = 1.5f;

/// An observed view at the size at which it was added, without its colour.
struct Observed {
  View view;
  std::function<Depth()> depth_again;  ///< where the view has no depth either

  View with_depth() const {
    if (!depth_again) return view;
    View whole = view;
    const cv::Size size(view.intrinsics.width, view.intrinsics.height);
    const Depth depth = depth_again();
    if (depth.empty()) throw Error("scene", "the depth of an observed view is gone");
    cv::resize(depth, whole.depth, size, 0, 0, cv::INTER_NEAREST_EXACT);  // as enlarged() does
    return whole;
  }
};

/// Whether a camera may see one of the pixels, once lifted.
bool in_sight(const View& view, const Mask& pixels, const View& camera) {
  constexpr double kMargin = 1;  // pixels; of rounding
  const Pose camera_from_view = camera.world_from_cam.inverse() * view.world_from_cam;
  const Intrinsics& k = camera.intrinsics;
  for (int y = 0; y < pixels.rows; ++y) {
    for (int x = 0; x < pixels.cols; ++x) {
      if (!pixels(y, x)) continue;
      const Eigen::Vector3d p = camera_from_view * view.intrinsics.lift(x, y, view.depth(y, x));
      if (!(p.z() > 0)) continue;
      const Eigen::Vector2d at = k.project(p);
      if (at.x() > -kMargin && at.y() > -kMargin && at.x() < k.width + kMargin &&
          at.y() < k.height + kMargin) {
        return true;
      }
    }
  }
  return false;
}

/// Of the pixels, those that would stand where an observed view looked through. One view's depth is
/// held at a time.
Mask refused_by(const std::vector<Observed>& observed, const SupportView& support,
                const FreeSpaceOptions& options) {
  Mask left = support.pixels.clone(), refused = Mask::zeros(left.size());
  for (const Observed& o : observed) {
    if (!in_sight(support.view, left, o.view)) continue;
    const Mask before = in_free_space(support.view, left, {o.with_depth()}, options);
    refused.setTo(1, before);
    left.setTo(0, before);
  }
  return refused;
}

}  // namespace

struct SceneBuilder::Impl {
  SceneNetworks networks;
  SceneOptions options;
  Intrinsics lens;
  SceneCloud cloud;
  std::vector<Observed> observed;
  Cloud points;
  bool changed = true;
  outpaint::Outpainter outpainter;

  Impl(const SceneNetworks& n, const Intrinsics& l, const SceneOptions& o)
      : networks(n), options(o), lens(network_lens(l)), cloud(o.cloud), outpainter(n.outpaint) {
    if (networks.depth == nullptr) throw Error("scene", "the depth network is missing");
    options.splat.background = {.5f, .5f, .5f};
  }

  bool fill(SupportView& support, const Splat& seen);
  void align(SupportView& support, const Splat& seen, const Depth& cloud_depth);
};

SceneBuilder::SceneBuilder(const SceneNetworks& networks, const Intrinsics& lens,
                           const SceneOptions& options)
    : impl_(std::make_unique<Impl>(networks, lens, options)) {}
SceneBuilder::~SceneBuilder() = default;
SceneBuilder::SceneBuilder(SceneBuilder&&) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&&) noexcept = default;

const Intrinsics& SceneBuilder::lens() const { return impl_->lens; }

const Cloud& SceneBuilder::cloud() {
  if (impl_->changed) impl_->points = impl_->cloud.cloud();
  impl_->changed = false;
  return impl_->points;
}

AddReport SceneBuilder::observe(const View& view, std::uint16_t number,
                                std::function<Depth()> depth_again) {
  check(view, "view " + std::to_string(number));
  const View large = enlarged(view);
  const AddReport report = impl_->cloud.add(large, number, Origin::observed);
  impl_->changed = true;
  const Depth held = depth_again ? Depth() : Depth(large.depth.clone());
  impl_->observed.push_back(
      {{{}, held, large.intrinsics, large.world_from_cam}, std::move(depth_again)});
  return report;
}

/// Outpaints what is missing. Returns false when it was stopped.
bool SceneBuilder::Impl::fill(SupportView& support, const Splat& seen) {
  const auto start = now();
  const outpaint::Outpainted filled =
      outpainter.run(to_network(seen.color), seen.missing, options.outpaint);
  if (filled.image.shape().pixels() == 0) return false;
  const Image picture = muted(from_network(filled.image), color_limit(points));
  support.view.color = continue_colors(seen.color, picture, seen.missing, options.colors);
  support.report.outpaint = filled.report;
  support.report.best = filled.best;
  support.report.outpaint_seconds = seconds_since(start);
  return true;
}

/// Depth of the picture, made to continue what is seen of the cloud.
void SceneBuilder::Impl::align(SupportView& support, const Splat& seen, const Depth& cloud_depth) {
  SupportReport& report = support.report;
  auto start = now();
  const Depth guess = photo_depth(*networks.depth, support.view.color, lens, networks.depth_scale);
  report.depth_seconds = seconds_since(start);
  start = now();
  const Mask visible = seen.hit & (seen.missing == 0);
  const AlignedDepth aligned =
      align_depth(guess, cloud_depth, visible, seen.missing, options.alignment);
  support.view.depth = aligned.depth;
  report.agreed = aligned.agreed;
  report.why = aligned.why;
  report.scale = aligned.scale;
  report.exponent = aligned.exponent;
  report.residual = aligned.residual;
  report.seam_step = aligned.seam_step;
  report.seam_step_before = aligned.seam_step_before;
  report.seam_step_seen = aligned.seam_step_seen;
  report.align_seconds = seconds_since(start);
}

SupportView SceneBuilder::outpaint(const Pose& world_from_cam, std::uint16_t number) {
  Impl& impl = *impl_;
  impl.options.outpaint.view = number;
  const auto start = now();
  const Splat seen = splat(cloud(), impl.lens, world_from_cam, impl.options.splat);
  SplatOptions narrow = impl.options.splat;
  narrow.radius = kCoverRadius;
  SupportView support;
  support.view.intrinsics = impl.lens;
  support.view.world_from_cam = world_from_cam;
  SupportReport& report = support.report;
  report.missing_share = cv::mean(seen.missing)[0];
  support.pixels = Mask::zeros(seen.missing.size());
  if (report.missing_share == 0) {
    support.view.color = seen.color;
    support.view.depth = seen.expected_depth;
    return support;
  }
  const Splat near = splat(cloud(), impl.lens, world_from_cam, narrow);
  report.splat_seconds = seconds_since(start);
  if (!impl.fill(support, seen)) return {};
  // Wide splats show slanted surfaces too near.
  Depth cloud_depth = seen.expected_depth.clone();
  near.expected_depth.copyTo(cloud_depth, near.hit);
  impl.align(support, seen, cloud_depth);
  support.pixels = seen.missing & (near.hit == 0);
  support.pixels.setTo(1, support.pixels);
  report.pixels = static_cast<std::size_t>(cv::countNonZero(support.pixels));
  const Mask before = refused_by(impl.observed, support, impl.options.free_space);
  support.pixels.setTo(0, before);
  report.refused = static_cast<std::size_t>(cv::countNonZero(before));
  return support;
}

AddReport SceneBuilder::add(const SupportView& support, std::uint16_t number) {
  if (cv::countNonZero(support.pixels) == 0) return {};
  impl_->changed = true;
  return impl_->cloud.add(support.view, number, Origin::outpainted, support.pixels);
}

}  // namespace ps
